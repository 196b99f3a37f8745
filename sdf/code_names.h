// Names in the generated code that are made from those of nodes: of the functions of definitions, and what the global
// names of each custom node's code end in. Code calls them "@" and a number; the text has a name there, the key of the
// program, which does not depend on names, the number.
#pragma once

#include "sdf/field_tree.h"

#include <map>
#include <set>
#include <string>
#include <vector>

namespace farfield {

class CodeNames {
public:
    explicit CodeNames(const FieldTree& tree);

    static std::string of_definition(std::size_t index);  ///< stands before "_distance" and "_surface"
    std::string of_custom(const FieldNode& node) const;

    /// The code with the names in it.
    std::string in(const std::string& code) const;

private:
    void add_definitions(const FieldTree& tree);
    void add_customs(const FieldNode& node, std::set<std::string>& taken);

    std::vector<std::string> names_;  ///< of the definitions, then of the custom nodes
    std::map<Id, std::size_t> customs_;
};

}  // namespace farfield
