#include "sdf/matching_ids.h"

#include <algorithm>
#include <unordered_map>
#include <unordered_set>

namespace farfield {
namespace {

using Names = std::unordered_map<std::string, const Node*>;

void gather_names(const Node& node, Names& names) {
    if (!node.name.empty()) names.emplace(node.name, &node);
    for (const Node& child : node.children) gather_names(child, names);
}

/// New ids by those that the scene came with.
class Matching {
public:
    explicit Matching(const Scene& old) : next_id_(old.next_id) {
        gather_names(old.root, names_);
        for (const Node& definition : old.definitions) gather_names(definition, names_);
    }

    /// `place`: the node of the old scene that stands where this one does; null for none.
    void match(const Node& node, const Node* place) {
        const Node* same = nullptr;
        if (!node.name.empty()) {
            const auto named = names_.find(node.name);
            if (named != names_.end()) same = named->second;
        } else if (place && place->name.empty() && place->kind == node.kind) {
            same = place;
        }
        add(node.id, same ? same->id : 0);
        for (std::size_t i = 0; i < node.children.size(); ++i)
            match(node.children[i], same && i < same->children.size() ? &same->children[i] : nullptr);
    }

    template <class Object>
    void match_names(const std::vector<Object>& objects, const std::vector<Object>& old) {
        for (const Object& object : objects) {
            const auto same =
                std::find_if(old.begin(), old.end(), [&](const Object& o) { return o.name == object.name; });
            add(object.id, same == old.end() ? 0 : same->id);
        }
    }

    Id operator[](Id id) const {
        const auto found = ids_.find(id);
        return found == ids_.end() ? 0 : found->second;
    }
    Id next_id() const { return next_id_; }

private:
    void add(Id id, Id same) { ids_[id] = same != 0 && taken_.insert(same).second ? same : next_id_++; }

    Names names_;
    std::unordered_map<Id, Id> ids_;
    std::unordered_set<Id> taken_;
    Id next_id_;
};

void rename(Node& node, const Matching& ids) {
    node.id = ids[node.id];
    node.material = ids[node.material];
    node.definition = ids[node.definition];
    for (Node& child : node.children) rename(child, ids);
}

}  // namespace

Scene with_ids_of(Scene scene, const Scene& old) {
    Matching ids(old);
    ids.match(scene.root, &old.root);
    for (const Node& definition : scene.definitions) ids.match(definition, nullptr);
    ids.match_names(scene.materials, old.materials);
    ids.match_names(scene.lights, old.lights);
    ids.match_names(scene.bookmarks, old.bookmarks);
    rename(scene.root, ids);
    for (Node& definition : scene.definitions) rename(definition, ids);
    for (Material& material : scene.materials) material.id = ids[material.id];
    for (Light& light : scene.lights) light.id = ids[light.id];
    for (Bookmark& bookmark : scene.bookmarks) bookmark.id = ids[bookmark.id];
    scene.next_id = ids.next_id();
    return scene;
}

}  // namespace farfield
