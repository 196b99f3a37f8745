#include "sdf/evaluate.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace farfield {

FieldEvaluator::FieldEvaluator(const Scene& scene) {
    if (!is_empty(scene.root)) root_.push_back(prepare(scene, scene.root, 0));
}

FieldEvaluator::Part FieldEvaluator::prepare(const Scene& scene, const Node& node, std::uint32_t inherited) {
    const KindInfo& kind = info(node.kind);
    Part part{&kind,
              {},
              node.transform.translate,
              glm::transpose(rotation_matrix(node.transform)),
              node.transform.scale,
              material_index(scene, node.material, inherited),
              {}};
    for (std::size_t i = 0; i < kind.parameters.size(); ++i)
        part.values.push_back(to_code_units(kind.parameters[i], node.values[i]));
    for (const Node& child : node.children)
        if (!is_empty(child)) part.children.push_back(prepare(scene, child, part.material));
    return part;
}

FieldEvaluator::Sample FieldEvaluator::fold(const Part& part, glm::vec3 p) {
    Sample result = evaluate(part.children[0], p);
    for (std::size_t i = 1; i < part.children.size(); ++i) {
        const Sample next = evaluate(part.children[i], p);
        if (part.kind->role == Role::combine) {
            const float share = part.kind->weight(result.distance, next.distance, part.values);
            result.material = blend_materials(result.material, next.material, share);
            result.distance = part.kind->combine(result.distance, next.distance, part.values);
        } else if (next.distance < result.distance) {
            result = next;
        }
    }
    return result;
}

FieldEvaluator::Sample FieldEvaluator::evaluate(const Part& part, glm::vec3 p) {
    const KindInfo& kind = *part.kind;
    const glm::vec3 q = part.to_own * (p - part.translate) / part.scale;
    Sample s{empty_distance, part.material};
    switch (kind.role) {
        case Role::primitive:
            s.distance = kind.primitive(q, part.values);
            break;
        case Role::combine:
            s = fold(part, q);
            break;
        case Role::distance:
            s = fold(part, q);
            s.distance = kind.distance(s.distance, q, part.values);
            break;
        case Role::domain:
            s = fold(part, kind.domain(q, part.values, 0));
            if (kind.distance) s.distance = kind.distance(s.distance, q, part.values);
            break;
        case Role::repeat:
            for (int cell = 0; cell < kind.cells(part.values); ++cell) {
                const Sample copy = fold(part, kind.domain(q, part.values, cell));
                if (copy.distance < s.distance) s = copy;
            }
            break;
    }
    s.distance *= part.scale;
    return s;
}

float FieldEvaluator::distance(glm::vec3 p) const {
    return root_.empty() ? empty_distance : evaluate(root_[0], p).distance;
}

std::uint32_t FieldEvaluator::material(glm::vec3 p) const { return root_.empty() ? 0 : evaluate(root_[0], p).material; }

glm::vec3 FieldEvaluator::normal(glm::vec3 p, float h) const {
    glm::vec3 gradient;
    for (int i = 0; i < 3; ++i) {
        glm::vec3 step(0.0f);
        step[i] = h;
        gradient[i] = distance(p + step) - distance(p - step);
    }
    const float length = glm::length(gradient);
    return length > 0.0f ? gradient / length : glm::vec3(0.0f, 1.0f, 0.0f);
}

}  // namespace farfield
