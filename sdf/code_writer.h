// The generator's functions, line by line: for the distance alone or for distance and material together.
#pragma once

#include "sdf/code_lines.h"
#include "sdf/field_tree.h"
#include "sdf/parameter_block.h"

#include <set>
#include <string>
#include <vector>

namespace farfield {

/// What a node comes to in the code: an expression of the distance and one of the material code.
struct Result {
    std::string distance;
    std::string material;
    bool named = false;   ///< the distance is a variable
    bool varies = false;  ///< the material is one: it is not the same everywhere
};

/// Whether a repetition's few cells stand in the code one after the other: not where they come to more than 16 nodes,
/// which drivers would compile for long. A program without loops traces more rays at once (renderer/trace_program.cpp).
bool writes_out_cells(const FieldNode& repetition);

/// Writes the functions of the definitions and of the scene.
class CodeWriter {
public:
    CodeWriter(const FieldTree& tree, const CodeNames& names, ParameterBlock& block, bool with_material)
        : tree_(tree), names_(names), block_(block), with_material_(with_material), functions_{names} {}

    /// The code of the custom nodes, once for each; `called` gets the names in it that are not its own.
    CodeLines custom_functions(std::string& called);

    /// The functions of the definitions, and the scene's.
    CodeLines write();

protected:
    /// A definition whose material is the same everywhere needs no function for it.
    void write_definition(std::size_t index);

    /// A node's numbers as they stand in the code: literals, or reads of the parameter block.
    struct Numbers {
        std::string point;      ///< p in the node's own frame
        std::string factor;     ///< brings own distances to the parent's frame: "0.5 * " or nothing
        std::string arguments;  ///< the parameters as further arguments: ", a, b"
        std::string derived;    ///< the derived values likewise
        std::string material;   ///< the material's index
        std::string low, high;  ///< corners of the region, where the node is stretched and has an end
        bool hard;              ///< all parameters are known to be zero
    };

    Numbers numbers(const FieldNode& n, const std::string& p);
    /// A ray's direction in the node's own frame.
    std::string direction(const FieldNode& n, const std::string& v);
    /// A node with children, as rays see it: point and direction in its own frame.
    struct Group {
        int id;
        Numbers numbers;
        std::string p, v;
    };
    Group begin(const FieldNode& n, const std::string& p, const std::string& v, CodeLines& out);
    static std::string read(const Parameter& parameter, std::size_t at);
    static std::string written(const Parameter& parameter, glm::vec3 v);
    Numbers live_numbers(const FieldNode& n, const std::string& p, std::size_t first) const;
    static Numbers literals(const FieldNode& n, const std::string& p);
    void add_derived(const FieldNode& n, Numbers& numbers);
    static std::string comment(const FieldNode& n);
    Result node(const FieldNode& n, const std::string& p, CodeLines& out, const std::string& indent);
    Result instance(const FieldNode& n, const std::string& p, CodeLines& out, const std::string& indent);

    /// A definition's material as the instance's function sees it.
    static std::string with_inherited(std::string material, const std::string& inherited);

    void custom_functions(const FieldNode& n, std::set<Id>& done, CodeLines& out, std::string& called);

    Result primitive(const FieldNode& n, const std::string& p);
    Result group(const FieldNode& n, const std::string& p, CodeLines& out, const std::string& indent);

    /// Gives the variable of the distance a new value.
    static void set(const Result& result, const std::string& value, const FieldNode& n, CodeLines& out,
                    const std::string& indent);

    /// Folds the children, one line each, into variables: the first child's where it has some, or those numbered `id`.
    /// The material needs none as long as it is the same.
    Result fold(const FieldNode& n, const Numbers& num, const std::string& p, int id, CodeLines& out,
                const std::string& indent);

    static std::string combination(const KindInfo& kind, const Numbers& num, const std::string& a,
                                   const std::string& b);

    /// The material code where `next` is combined with `so_far`; next.distance must be a variable.
    static std::string blend(const KindInfo& kind, const Numbers& num, const Result& so_far, const Result& next);

    Result domain(const FieldNode& n, const Numbers& num, const std::string& p, int id, CodeLines& out,
                  const std::string& indent);

    /// The content becomes a function of its own, called for each cell that can hold the nearest copy.
    Result repeat(const FieldNode& n, const Numbers& num, const std::string& p, int id, CodeLines& out,
                  const std::string& indent);

    const FieldTree& tree_;
    const CodeNames& names_;
    ParameterBlock& block_;
    bool with_material_;
    CodeLines functions_;
    std::vector<Result> materials_;  ///< of the definitions
    bool in_definition_ = false;
    int next_group_ = 0;
    int next_child_ = 0;
    int next_copy_ = 0;          ///< counts the same for all functions, so that they share the contents of repetitions
    bool writes_copies_ = true;  ///< these contents, unless that was done before
};

}  // namespace farfield
