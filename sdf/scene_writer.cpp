// Text from scene: one value to a line, defaults left out, always in the order of the tables.
#include "sdf/custom_code.h"
#include "sdf/fields.h"
#include "sdf/scene_format.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <unordered_map>

namespace farfield {
namespace {

std::string text_of(std::string_view text) {
    return nlohmann::json(text).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

/// The shortest text that reads back as the same float; zero without a sign.
std::string text_of(float number) { return fmt::format("{}", number + 0.0f); }

std::string text_of(const Parameter& parameter, glm::vec3 value) {
    if (parameter.type == ParameterType::choice)
        return text_of(parameter.choices[static_cast<size_t>(clamped(parameter, value).x)]);
    if (parameter.type == ParameterType::flag) return fmt::format("{}", value.x != 0.0f);
    if (parameter.is_word(value.x)) return text_of(parameter.word);
    if (parameter.components() == 1) return text_of(value.x);
    if (parameter.type == ParameterType::flags)
        return fmt::format("[{}, {}, {}]", value.x != 0.0f, value.y != 0.0f, value.z != 0.0f);
    return fmt::format("[{}, {}, {}]", text_of(value.x), text_of(value.y), text_of(value.z));
}

class Writer {
public:
    explicit Writer(const Scene& scene) : scene_(scene) {
        for (const Node& definition : scene.definitions) definition_names_.emplace(definition.id, definition.name);
        begin({}, '{');
        if (!scene.schema.empty()) line(format::schema, text_of(scene.schema));
        line(format::version_key, fmt::format("{}", format::version));
        section(format::camera, scene.camera);
        if (!scene.bookmarks.empty()) {
            begin(format::bookmarks, '{');
            for (const Bookmark& bookmark : scene.bookmarks) {
                begin(bookmark.name, '{');
                all_fields(bookmark.camera);
                end('}');
            }
            end('}');
        }
        section(format::settings, scene.settings);
        section(format::sky, scene.sky);
        begin(format::materials, '{');
        for (const Material& material : scene.materials) {
            begin(material.name, '{');
            all_fields(material);
            end('}');
        }
        end('}');
        if (!scene.lights.empty()) {
            begin(format::lights, '{');
            for (const Light& light : scene.lights) {
                begin(light.name, '{');
                line(format::kind, text_of(light_kind_keys[static_cast<size_t>(light.kind)]));
                some_fields(light, [&](std::string_view key) { return applies(light, key); });
                end('}');
            }
            end('}');
        }
        if (!scene.definitions.empty()) {
            begin(format::definitions, '[');
            for (const Node& definition : scene.definitions) node({}, definition);
            end(']');
        }
        node(format::root, scene.root);
        end('}');
        text_ += '\n';
    }

    std::string take() { return std::move(text_); }

private:
    void new_line() { (text_ += '\n').append(static_cast<size_t>(2 * depth_), ' '); }
    /// Starts a member, or an array's element where the key is a null view.
    void item(std::string_view key) {
        if (!first_) text_ += ',';
        if (depth_ > 0) new_line();
        first_ = false;
        if (key.data()) text_ += text_of(key) + ": ";
    }
    void line(std::string_view key, const std::string& value) {
        item(key);
        text_ += value;
    }
    void begin(std::string_view key, char bracket) {
        item(key);
        text_ += bracket;
        first_ = true;
        ++depth_;
    }
    void end(char bracket) {
        --depth_;
        if (!first_) new_line();
        text_ += bracket;
        first_ = false;
    }

    void value(const Parameter& parameter, glm::vec3 value, glm::vec3 initial) {
        const bool differs = parameter.components() == 1 ? value.x != initial.x : value != initial;
        if (differs) line(parameter.key, text_of(parameter, value));
    }
    template <class T, class Applies>
    void some_fields(const T& object, Applies applies) {
        const T initial;
        for (const Field<T>& field : fields<T>())
            if (applies(field.parameter.key)) value(field.parameter, field.get(object), field.get(initial));
    }
    template <class T>
    void all_fields(const T& object) {
        some_fields(object, [](std::string_view) { return true; });
    }
    template <class T>
    void section(std::string_view key, const T& object) {
        const size_t before = text_.size();
        begin(key, '{');
        const size_t empty = text_.size();
        all_fields(object);
        const bool nothing = text_.size() == empty;
        end('}');
        if (nothing) text_.resize(before);
    }

    void code(std::string_view text) {
        begin(format::code, '[');
        for (;;) {
            const size_t stop = text.find('\n');
            line({}, text_of(text.substr(0, stop)));
            if (stop == text.npos) break;
            text.remove_prefix(stop + 1);
        }
        end(']');
    }

    void node(std::string_view key, const Node& node) {
        const KindInfo& kind = info(node.kind);
        begin(key, '{');
        line(format::kind, text_of(kind.key));
        if (!node.name.empty()) line(format::name, text_of(node.name));
        if (const auto of = definition_names_.find(node.definition); of != definition_names_.end())
            line(format::of, text_of(of->second));
        if (const Material* material = find_material(scene_, node.material))
            line(format::material, text_of(material->name));
        if (node.hidden) line(format::hidden, "true");
        if (node.locked) line(format::locked, "true");
        if (node.code) code(node.code->text());
        const std::vector<Parameter> list = parameters(node);
        for (size_t i = 0; i < list.size(); ++i) value(list[i], node.values[i], list[i].initial);
        all_fields(node.transform);
        if (!node.children.empty()) {
            begin(format::children, '[');
            for (const Node& child : node.children) this->node({}, child);
            end(']');
        }
        end('}');
    }

    const Scene& scene_;
    std::unordered_map<Id, std::string> definition_names_;
    std::string text_;
    int depth_ = 0;
    bool first_ = true;  ///< of the items in the innermost container
};

}  // namespace

std::string to_text(const Scene& scene) { return Writer(scene).take(); }

}  // namespace farfield
