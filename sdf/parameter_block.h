// The numbers that generated code reads at run time instead of holding them as literals.
#pragma once

#include "sdf/codegen.h"
#include "sdf/field_tree.h"

#include <map>
#include <set>
#include <vector>

namespace farfield {

/// Which numbers are live, and where their nodes' values stand in the parameter block: translation, inverse rotation by
/// columns, scale, the kind's parameters, material index. What follows from a node's content stands apart: it is live
/// where anything below is.
class ParameterBlock {
public:
    ParameterBlock(const FieldTree& tree, Tier tier, Id tuned);

    bool is_live(const FieldNode& n) const { return all_ || (tuned_ != 0 && n.id == tuned_); }
    bool is_derived_live(const FieldNode& n) const { return all_ || nodes_above_tuned_.contains(n.id); }

    /// Index of the node's first value; both functions of the program share it.
    std::size_t first(const FieldNode& n);
    /// Index of the first derived value; the low and high corner of the region follow where the node needs them.
    std::size_t first_derived(const FieldNode& n);
    /// From a node's first value on.
    static constexpr std::size_t scale_offset = 12, parameters_offset = 13;

    std::vector<float> values;

private:
    void add(glm::vec3 v) { values.insert(values.end(), {v.x, v.y, v.z}); }
    void add(const Parameter& parameter, glm::vec3 v);
    bool find_above(const FieldNode& n);

    bool all_;
    Id tuned_;
    std::vector<bool> above_tuned_;  ///< for each definition
    std::set<Id> nodes_above_tuned_;
    std::map<Id, std::size_t> first_, first_derived_;
};

}  // namespace farfield
