#include "sdf/evaluate.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace farfield {

FieldEvaluator::Sample FieldEvaluator::fold(const FieldNode& node, glm::vec3 p, std::uint32_t inherited) const {
    Sample result = evaluate(node.children[0], p, inherited);
    for (std::size_t i = 1; i < node.children.size(); ++i) {
        const Sample next = evaluate(node.children[i], p, inherited);
        if (node.kind->role == Role::combine) {
            const float share = node.kind->weight(result.distance, next.distance, node.values);
            result.material = blend_materials(result.material, next.material, share);
            if (share > 0.5f) result.owner = next.owner;
            result.distance = node.kind->combine(result.distance, next.distance, node.values);
        } else if (next.distance < result.distance) {
            result = next;
        }
    }
    return result;
}

float FieldEvaluator::custom(const FieldNode& node, glm::vec3 p) {
    const glm::vec3 bounds = node.values[0], nearest = nearest_custom(p, bounds);
    const float value = node.code->evaluate(nearest, std::span(node.values).subspan(node.kind->parameters.size()));
    return custom_distance(value, node.code->lipschitz(), p, nearest, bounds);
}

FieldEvaluator::Sample FieldEvaluator::evaluate(const FieldNode& node, glm::vec3 p, std::uint32_t inherited) const {
    const KindInfo& kind = *node.kind;
    const glm::vec3 q = node.to_own * (p - node.translate) / node.scale;
    Sample s{empty_distance, node.material == inherited_material ? inherited : node.material, node.id};
    switch (kind.role) {
        case Role::primitive:
            s.distance = node.code ? custom(node, q) : kind.primitive(q, node.values);
            break;
        case Role::combine:
            s = fold(node, q, inherited);
            break;
        case Role::distance:
            s = fold(node, q, inherited);
            s.distance = kind.distance(s.distance, q, node.values);
            break;
        case Role::domain: {
            const glm::vec3 nearest = kind.confined ? glm::clamp(q, node.region.low, node.region.high) : q;
            s = fold(node, kind.domain ? kind.domain(nearest, node.values, 0) : nearest, inherited);
            if (kind.distance) s.distance = kind.distance(s.distance, nearest, node.values);
            if (kind.confined) s.distance = beyond(s.distance, q - nearest);
            break;
        }
        case Role::repeat:
            for (int cell = 0; cell < kind.cells(node.values); ++cell) {
                const glm::vec3 in_copy = kind.domain(q, node.values, cell);
                Sample copy = fold(node, in_copy, inherited);
                if (node.guarded) copy.distance = kind.guarded_copy(copy.distance, in_copy, node.values, node.region);
                if (copy.distance < s.distance) s = copy;
            }
            if (node.guarded) s.distance = kind.guarded_nearest(s.distance, q, node.values, node.region);
            break;
        case Role::instance:
            s = evaluate(tree_.definitions[node.definition], q, s.material);
            s.owner = node.id;
            break;
    }
    s.distance *= node.scale;
    return s;
}

float FieldEvaluator::unsafe_distance(const FieldNode& node, glm::vec3 p) const {
    const KindInfo& kind = *node.kind;
    if (kind.domain) return fold(node, kind.domain(p, node.values, 0), 0).distance;
    return kind.distance(fold(node, p, 0).distance, p, node.values) * node.stretch();
}

float FieldEvaluator::distance(glm::vec3 p) const {
    return !tree_.root ? empty_distance : evaluate(*tree_.root, p, 0).distance;
}

std::uint32_t FieldEvaluator::material(glm::vec3 p) const {
    return !tree_.root ? 0 : evaluate(*tree_.root, p, 0).material;
}

Id FieldEvaluator::owner(glm::vec3 p) const { return !tree_.root ? 0 : evaluate(*tree_.root, p, 0).owner; }

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
