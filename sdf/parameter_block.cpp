#include "sdf/parameter_block.h"

namespace farfield {

ParameterBlock::ParameterBlock(const FieldTree& tree, Tier tier, Id tuned) : all_(tier == Tier::live), tuned_(tuned) {
    if (tuned == 0) return;
    for (const FieldNode& definition : tree.definitions) above_tuned_.push_back(find_above(definition));
    if (tree.root) find_above(*tree.root);
}

std::size_t ParameterBlock::first(const FieldNode& n) {
    const auto [place, fresh] = first_.try_emplace(n.id, values.size());
    if (!fresh) return place->second;
    add(n.translate);
    for (int column = 0; column < 3; ++column) add(n.to_own[column]);
    values.push_back(n.scale);
    for (std::size_t i = 0; i < n.parameters.size(); ++i) add(n.parameters[i], n.values[i]);
    values.push_back(n.material == inherited_material ? -1.0f : static_cast<float>(n.material));
    return place->second;
}

std::size_t ParameterBlock::first_derived(const FieldNode& n) {
    const auto [place, fresh] = first_derived_.try_emplace(n.id, values.size());
    if (!fresh) return place->second;
    for (std::size_t i = 0; i < n.kind->derived.size(); ++i)
        add(n.kind->derived[i], n.values[n.kind->parameters.size() + i]);
    if (n.kind->confined || n.guarded) add(n.region.low), add(n.region.high);
    return place->second;
}

void ParameterBlock::add(const Parameter& parameter, glm::vec3 v) {
    if (parameter.components() == 1)
        values.push_back(v.x);
    else
        add(v);
}

/// Whether the tuned node is this one or below it; remembers those for which it is.
bool ParameterBlock::find_above(const FieldNode& n) {
    bool found = n.id == tuned_ || (n.kind->role == Role::instance && above_tuned_[n.definition]);
    for (const FieldNode& child : n.children) found = find_above(child) || found;
    if (found) nodes_above_tuned_.insert(n.id);
    return found;
}

}  // namespace farfield
