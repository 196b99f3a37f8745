#include "sdf/custom_ranges.h"

#include <fmt/format.h>
#include <glslang/Include/intermediate.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <set>

namespace farfield {

using namespace glslang;

void refuse(int line, const std::string& why) { throw Refused(line, why); }

int line_of(TIntermNode* node) {
    const TSourceLoc& at = node->getLoc();
    return at.string == 1 ? std::max(at.line, 1) : 1;
}

namespace {

bool assigns(TOperator op) {
    return (op >= EOpPostIncrement && op <= EOpPreDecrement) || (op >= EOpAssign && op <= EOpRightShiftAssign);
}

/// The variable that an assignment to `target` changes; null where there is none.
TIntermSymbol* changed_variable(TIntermTyped* target) {
    while (TIntermBinary* binary = target->getAsBinaryNode()) target = binary->getLeft();
    return target->getAsSymbolNode();
}

/// All variables that a tree changes.
class Changes : public TIntermTraverser {
public:
    bool visitUnary(TVisit, TIntermUnary* node) override {
        if (assigns(node->getOp())) add(node->getOperand());
        return true;
    }
    bool visitBinary(TVisit, TIntermBinary* node) override {
        if (assigns(node->getOp())) add(node->getLeft());
        return true;
    }
    bool visitAggregate(TVisit, TIntermAggregate* node) override {
        if (node->getOp() == EOpModf) add(node->getSequence()[1]->getAsTyped());
        if (node->getOp() == EOpFunctionCall)
            for (std::size_t i = 0; i < node->getSequence().size(); ++i)
                if (const TStorageQualifier q = node->getQualifierList()[i]; q == EvqOut || q == EvqInOut)
                    add(node->getSequence()[i]->getAsTyped());
        return true;
    }
    std::multiset<long long> variables;

private:
    void add(TIntermTyped* target) {
        TIntermSymbol* symbol = changed_variable(target);
        variables.insert(symbol ? symbol->getId() : -1);
    }
};

std::multiset<long long> changes(TIntermNode* node) {
    Changes found;
    if (node) node->traverse(&found);
    return found.variables;
}

bool is_whole(const TIntermTyped* node) {
    return node->isScalar() && (node->getBasicType() == EbtInt || node->getBasicType() == EbtUint);
}

/// Not beyond what the type of `node` holds, or everything.
Range checked(Range r, const TIntermTyped* node) {
    const bool is_unsigned = node->getBasicType() == EbtUint;
    const double least = is_unsigned ? 0.0 : INT32_MIN, most = is_unsigned ? UINT32_MAX : INT32_MAX;
    return r.low >= least && r.high <= most ? r : Range{};
}

Range whole_arithmetic(TOperator op, Range a, Range b) {
    switch (op) {
        case EOpAdd:
            return {a.low + b.low, a.high + b.high};
        case EOpSub:
            return {a.low - b.high, a.high - b.low};
        case EOpMul: {
            const auto [low, high] = std::minmax({a.low * b.low, a.low * b.high, a.high * b.low, a.high * b.high});
            return std::isfinite(low) && std::isfinite(high) ? Range{low, high} : Range{};
        }
        case EOpDiv:
            if (b.low != b.high || b.low < 1.0) return {};
            return {std::trunc(a.low / b.low), std::trunc(a.high / b.low)};
        case EOpMod:  // of a negative number it is undefined
            return a.low >= 0.0 && b.low == b.high && b.low >= 1.0 ? Range{0.0, b.low - 1.0} : Range{};
        case EOpAnd:
            return b.low == b.high && b.low >= 0.0 ? Range{0.0, b.low} : Range{};
        case EOpMin:
            return {std::min(a.low, b.low), std::min(a.high, b.high)};
        case EOpMax:
            return {std::max(a.low, b.low), std::max(a.high, b.high)};
        default:
            return {};
    }
}

/// The condition on a loop's variable among those that && connects.
TIntermBinary* comparison(TIntermTyped* test) {
    TIntermBinary* binary = test->getAsBinaryNode();
    if (!binary) return nullptr;
    switch (binary->getOp()) {
        case EOpLogicalAnd:
            if (TIntermBinary* found = comparison(binary->getLeft())) return found;
            return comparison(binary->getRight());
        case EOpLessThan:
        case EOpLessThanEqual:
        case EOpGreaterThan:
        case EOpGreaterThanEqual:
        case EOpNotEqual:
            return binary->getLeft()->getAsSymbolNode() && binary->getLeft()->isScalar() ? binary : nullptr;
        default:
            return nullptr;
    }
}

/// The initial value of the variable in the statement before the loop.
TIntermTyped* initial_value(TIntermNode* before, long long variable) {
    if (!before) return nullptr;
    if (TIntermAggregate* sequence = before->getAsAggregate()) {
        if (sequence->getOp() != EOpSequence) return nullptr;
        for (TIntermNode* child : sequence->getSequence())
            if (TIntermTyped* found = initial_value(child, variable)) return found;
        return nullptr;
    }
    TIntermBinary* assignment = before->getAsBinaryNode();
    if (!assignment || assignment->getOp() != EOpAssign) return nullptr;
    TIntermSymbol* symbol = assignment->getLeft()->getAsSymbolNode();
    return symbol && symbol->getId() == variable ? assignment->getRight() : nullptr;
}

/// What the expression after the loop's second semicolon adds to the variable; 0 where it is not that simple.
double step(TIntermTyped* terminal, long long variable) {
    const auto is_variable = [&](TIntermTyped* node) {
        TIntermSymbol* symbol = node->getAsSymbolNode();
        return symbol && symbol->getId() == variable;
    };
    if (TIntermUnary* unary = terminal->getAsUnaryNode(); unary && is_variable(unary->getOperand())) {
        const TOperator op = unary->getOp();
        if (op == EOpPreIncrement || op == EOpPostIncrement) return 1.0;
        if (op == EOpPreDecrement || op == EOpPostDecrement) return -1.0;
    }
    if (TIntermAggregate* comma = terminal->getAsAggregate(); comma && comma->getOp() == EOpComma)
        for (TIntermNode* part : comma->getSequence())
            if (const double by = step(part->getAsTyped(), variable); by != 0.0) return by;
    TIntermBinary* binary = terminal->getAsBinaryNode();
    if (!binary) return 0.0;
    TIntermConstantUnion* constant = binary->getRight()->getAsConstantUnion();
    if (!constant || !is_variable(binary->getLeft())) return 0.0;
    const TConstUnion& c = constant->getConstArray()[0];
    const double amount = c.getType() == EbtDouble ? static_cast<float>(c.getDConst())
                          : c.getType() == EbtInt  ? static_cast<double>(c.getIConst())
                                                   : static_cast<double>(c.getUConst());
    return binary->getOp() == EOpAddAssign ? amount : binary->getOp() == EOpSubAssign ? -amount : 0.0;
}

bool holds(TOperator op, double i, double end) {
    switch (op) {
        case EOpLessThan:
            return i < end;
        case EOpLessThanEqual:
            return i <= end;
        case EOpGreaterThan:
            return i > end;
        case EOpGreaterThanEqual:
            return i >= end;
        default:
            return i != end;
    }
}

}  // namespace

bool has_effects(TIntermNode* node) { return !changes(node).empty(); }

Ranges::Ranges(const std::vector<CustomInput>& inputs) {
    for (const CustomInput& input : inputs)
        if (input.cells == 1) inputs_[input.name] = {input.minimum, input.maximum};
}

Range Ranges::of(TIntermTyped* node) const {
    Range range = is_whole(node) ? known(node) : Range{};
    if (node->getBasicType() == EbtUint) range.low = std::max(range.low, 0.0);
    return range;
}

Range Ranges::known(TIntermTyped* node) const {
    if (TIntermConstantUnion* constant = node->getAsConstantUnion()) {
        const TConstUnion& c = constant->getConstArray()[0];
        const double v = c.getType() == EbtUint ? c.getUConst() : c.getIConst();
        return {v, v};
    }
    if (TIntermSymbol* symbol = node->getAsSymbolNode()) {
        const auto input = inputs_.find(symbol->getName().c_str());
        if (symbol->getQualifier().storage == EvqUniform && input != inputs_.end()) return input->second;
        const auto variable = variables_.find(symbol->getId());
        return variable == variables_.end() ? Range{} : variable->second;
    }
    if (TIntermUnary* unary = node->getAsUnaryNode()) {
        const Range r = of(unary->getOperand());
        switch (unary->getOp()) {
            case EOpNegative:
                return checked({-r.high, -r.low}, node);
            case EOpConvIntToUint:
            case EOpConvUintToInt:
                return checked(r, node);
            case EOpConvBoolToInt:
            case EOpConvBoolToUint:
                return {0.0, 1.0};
            default:
                return {};
        }
    }
    if (TIntermBinary* binary = node->getAsBinaryNode())
        return checked(whole_arithmetic(binary->getOp(), of(binary->getLeft()), of(binary->getRight())), node);
    if (TIntermSelection* selection = node->getAsSelectionNode()) {
        const Range a = of(selection->getTrueBlock()->getAsTyped()), b = of(selection->getFalseBlock()->getAsTyped());
        return {std::min(a.low, b.low), std::max(a.high, b.high)};
    }
    TIntermAggregate* aggregate = node->getAsAggregate();
    if (!aggregate) return {};
    const TIntermSequence& args = aggregate->getSequence();
    const auto arg = [&](std::size_t i) { return of(args[i]->getAsTyped()); };
    if ((aggregate->getOp() == EOpMin || aggregate->getOp() == EOpMax) && args.size() == 2)
        return whole_arithmetic(aggregate->getOp(), arg(0), arg(1));
    if (aggregate->getOp() == EOpClamp && args.size() == 3)
        return whole_arithmetic(EOpMin, whole_arithmetic(EOpMax, arg(0), arg(1)), arg(2));
    return {};
}

LoopSteps Ranges::steps(TIntermLoop* loop, TIntermNode* before, double most) const {
    const int line = line_of(loop);
    const auto unknown = [&](const char* why) {
        refuse(line, fmt::format("the number of steps of this loop is not known: {}", why));
    };
    TIntermBinary* test = comparison(loop->getTest());
    if (!test) unknown("expected a condition as i < 8");
    TIntermSymbol* variable = test->getLeft()->getAsSymbolNode();
    const long long id = variable->getId();
    TIntermTyped* start = initial_value(before, id);
    if (!start) unknown("expected the loop to start with its own variable, as int i = 0");
    const double by = step(loop->getTerminal(), id);
    if (by == 0.0) unknown("expected ++i, --i or i += with a constant");
    if (changes(loop->getBody()).contains(id) || changes(loop->getTest()).contains(id) ||
        changes(loop->getTerminal()).count(id) != 1)
        unknown("its variable must change only once for each step");

    const bool whole = is_whole(variable);
    Range first, end;
    if (whole) {
        first = of(start), end = of(test->getRight());
    } else {
        TIntermConstantUnion* a = start->getAsConstantUnion();
        TIntermConstantUnion* b = test->getRight()->getAsConstantUnion();
        if (!a || !b || variable->getBasicType() != EbtFloat) unknown("start and end must be constants");
        first.low = first.high = static_cast<float>(a->getConstArray()[0].getDConst());
        end.low = end.high = static_cast<float>(b->getConstArray()[0].getDConst());
    }
    if (!std::isfinite(first.low) || !std::isfinite(first.high) || !std::isfinite(end.low) || !std::isfinite(end.high))
        unknown("its limits must be constants or int uniforms with a range");
    if (test->getOp() == EOpNotEqual && (first.low != first.high || end.low != end.high))
        unknown("with != its limits must be constants");

    // The most steps come from the farthest ends.
    const double from = by > 0.0 ? first.low : first.high, to = by > 0.0 ? end.high : end.low;
    const bool is_unsigned = variable->getBasicType() == EbtUint;
    double i = from, count = 0.0;
    while (holds(test->getOp(), i, to)) {
        if (++count > most) refuse(line, fmt::format("this loop may take more than {:.0f} steps", most));
        i = whole ? i + by : static_cast<float>(i) + static_cast<float>(by);
        if (whole && (i < (is_unsigned ? 0.0 : INT32_MIN) || i > (is_unsigned ? UINT32_MAX : INT32_MAX)))
            unknown("its variable leaves the range of its type");
    }
    const bool inclusive = test->getOp() == EOpLessThanEqual || test->getOp() == EOpGreaterThanEqual;
    const double beyond = inclusive ? 0.0 : 1.0;  // with != too: the variable comes to the end exactly, or not at all
    Range range;
    if (whole) range = by > 0.0 ? Range{first.low, to - beyond} : Range{to + beyond, first.high};
    return {count, id, range};
}

}  // namespace farfield
