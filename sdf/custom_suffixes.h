// What the global names of each custom node's code end in within a program: the node's name in camel case, or a number.
// All other names there are small, with underscores, or all capitals; so no two are the same.
#pragma once

#include "sdf/field_tree.h"

#include <map>
#include <set>
#include <string>

namespace farfield {

class CustomSuffixes {
public:
    /// Without `by_name` the names of nodes do not matter.
    CustomSuffixes(const FieldTree& tree, bool by_name);
    const std::string& of(const FieldNode& custom) const { return suffixes_.at(custom.id); }
    bool empty() const { return suffixes_.empty(); }

private:
    void gather(const FieldNode& node);

    bool by_name_;
    std::map<Id, std::string> suffixes_;
    std::set<std::string> taken_;
};

}  // namespace farfield
