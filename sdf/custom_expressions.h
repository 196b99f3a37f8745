// Expressions of custom code: from glslang's tree to instructions that leave the value in a known place.
#pragma once

#include "sdf/custom_builder.h"

#include <span>
#include <string>

namespace farfield::custom {

class Expressions : protected Builder {
protected:
    explicit Expressions(const std::vector<CustomInput>& inputs) : ranges_(inputs) {
        for (const CustomInput& input : inputs) {
            inputs_.emplace(input.name, program_.cells);
            program_.cells += input.cells;
        }
    }

    Function& called(TIntermAggregate* call);
    Value variable(TIntermSymbol* symbol);
    Place place(TIntermTyped* node);
    /// The place of `node`; where it is a value that `later` could change, a copy of it.
    Place place_kept(TIntermTyped* node, TIntermTyped* later);
    Place element(Place p, const TType& type, TIntermTyped* index, TIntermTyped* node);
    Value expression(TIntermTyped* node);
    [[noreturn]] void unsupported(TIntermNode* node) const;
    Value literal(TIntermConstantUnion* node);
    /// Operands from left to right; what a later one might change is copied first.
    std::vector<Value> values(std::span<TIntermNode* const> nodes);
    Value alternative(TIntermSelection* node);
    Value unary_expression(TIntermUnary* node);
    Value binary_expression(TIntermBinary* node);
    Value modf(TIntermAggregate* node);
    Value call(TIntermAggregate* node);
    Value apply(TOperator op, const std::vector<Value>& args, TIntermTyped& node);
    Value arithmetic(TOperator op, const std::vector<Value>& args, TIntermTyped* node);
    Value equality(bool equal, const std::vector<Value>& args, TIntermTyped& node);
    Value construct(const TType& type, std::vector<Value> args, TIntermTyped& node);
    /// From a scalar: on the diagonal; from a matrix: its upper left part, the identity beyond it.
    Value matrix_of(const TType& type, const Value& v, TIntermTyped& node, const Value& result);

    Ranges ranges_;
    std::map<std::string, Function> functions_;  ///< by glslang's name, with the parameters' types

private:
    std::map<std::string, int> inputs_;
    std::map<long long, int> variables_;
};

}  // namespace farfield::custom
