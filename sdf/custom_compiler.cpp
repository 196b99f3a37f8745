#include "sdf/custom_compiler.h"

#include "sdf/custom_ranges.h"

#include <fmt/format.h>
#include <glslang/Include/intermediate.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <map>
#include <optional>
#include <span>

namespace farfield {
namespace {

using namespace glslang;

constexpr int most_cells = 4096;
constexpr std::size_t deepest_call = 60;

/// Where a value lies. A scalar operand serves for all components of a vector.
struct Value {
    int at = 0;
    int cells = 0;
    TBasicType base = EbtVoid;
};

/// A value that may be assigned to: cells at a fixed place, at one that depends on an index, or picked by a swizzle.
struct Place {
    Value value;
    int offset = no_offset;
    std::vector<int> selectors = {};  ///< relative to value.at
};

struct Function {
    TIntermAggregate* node = nullptr;
    enum { unknown, open, done, broken } state = unknown;
    std::vector<Value> parameters;
    Value result;
    int start = 0;
    std::size_t depth = 0;  ///< of calls below
    double operations = 0.0, repetitions = 0.0, inlined = 0.0;
};

/// Ends a function's compilation without a message of its own.
struct CallsBroken {};

int cells_of(const TType& type, int line) {
    std::int64_t cells = 1;
    if (type.isArray()) {
        if (!type.isSizedArray()) refuse(line, "an array needs a size");
        for (int i = 0; i < type.getArraySizes()->getNumDims(); ++i) {
            cells *= type.getArraySizes()->getDimSize(i);
            if (cells > most_cells) refuse(line, "this array is too large");
        }
    }
    if (type.isStruct()) {
        std::int64_t sum = 0;
        for (const TTypeLoc& member : *type.getStruct()) sum += cells_of(*member.type, line);
        cells *= sum;
    } else if (type.isMatrix()) {
        cells *= type.getMatrixCols() * type.getMatrixRows();
    } else {
        cells *= type.getVectorSize();
    }
    const TBasicType base = type.getBasicType();
    if (base != EbtFloat && base != EbtInt && base != EbtUint && base != EbtBool && base != EbtStruct &&
        base != EbtVoid)
        refuse(line, fmt::format("the type {} is not available in distance code", type.getBasicTypeString().c_str()));
    if (cells > most_cells) refuse(line, "this array is too large");
    return static_cast<int>(cells);
}

/// One operation for each type of component.
struct Row {
    TOperator from;
    Operation f, i, u;
    bool swapped = false;
};
constexpr Operation no = Operation::return_;  // none for this type
using O = Operation;

constexpr Row unary_rows[] = {
    {EOpNegative, O::negate_f, O::negate_i, O::negate_i},
    {EOpBitwiseNot, no, O::not_i, O::not_i},
    {EOpRadians, O::radians, no, no},
    {EOpDegrees, O::degrees, no, no},
    {EOpSin, O::sin, no, no},
    {EOpCos, O::cos, no, no},
    {EOpTan, O::tan, no, no},
    {EOpAsin, O::asin, no, no},
    {EOpAcos, O::acos, no, no},
    {EOpAtan, O::atan, no, no},
    {EOpSinh, O::sinh, no, no},
    {EOpCosh, O::cosh, no, no},
    {EOpTanh, O::tanh, no, no},
    {EOpAsinh, O::asinh, no, no},
    {EOpAcosh, O::acosh, no, no},
    {EOpAtanh, O::atanh, no, no},
    {EOpExp, O::exp, no, no},
    {EOpLog, O::log, no, no},
    {EOpExp2, O::exp2, no, no},
    {EOpLog2, O::log2, no, no},
    {EOpSqrt, O::sqrt, no, no},
    {EOpInverseSqrt, O::inversesqrt, no, no},
    {EOpAbs, O::abs_f, O::abs_i, no},
    {EOpSign, O::sign_f, O::sign_i, no},
    {EOpFloor, O::floor, no, no},
    {EOpTrunc, O::trunc, no, no},
    {EOpRound, O::round, no, no},
    {EOpRoundEven, O::round, no, no},
    {EOpCeil, O::ceil, no, no},
    {EOpFract, O::fract, no, no},
    {EOpIsNan, O::isnan, no, no},
    {EOpIsInf, O::isinf, no, no},
};

constexpr Row binary_rows[] = {
    {EOpAdd, O::add_f, O::add_i, O::add_i},
    {EOpSub, O::subtract_f, O::subtract_i, O::subtract_i},
    {EOpMul, O::multiply_f, O::multiply_i, O::multiply_i},
    {EOpVectorTimesScalar, O::multiply_f, O::multiply_i, O::multiply_i},
    {EOpMatrixTimesScalar, O::multiply_f, no, no},
    {EOpDiv, O::divide_f, O::divide_i, O::divide_u},
    {EOpMod, O::mod_f, O::mod_i, O::mod_u},
    {EOpRightShift, no, O::shift_right_i, O::shift_right_u},
    {EOpLeftShift, no, O::shift_left, O::shift_left},
    {EOpAnd, no, O::and_i, O::and_i},
    {EOpInclusiveOr, no, O::or_i, O::or_i},
    {EOpExclusiveOr, no, O::xor_i, O::xor_i},
    {EOpLessThan, O::less_f, O::less_i, O::less_u},
    {EOpGreaterThan, O::less_f, O::less_i, O::less_u, true},
    {EOpLessThanEqual, O::less_equal_f, O::less_equal_i, O::less_equal_u},
    {EOpGreaterThanEqual, O::less_equal_f, O::less_equal_i, O::less_equal_u, true},
    {EOpVectorEqual, O::equal_f, O::equal_i, O::equal_i},
    {EOpVectorNotEqual, O::not_equal_f, O::not_equal_i, O::not_equal_i},
    {EOpMin, O::min_f, O::min_i, O::min_u},
    {EOpMax, O::max_f, O::max_i, O::max_u},
    {EOpPow, O::pow, no, no},
    {EOpAtan, O::atan2, no, no},
    {EOpStep, O::step, no, no},
};

constexpr Row ternary_rows[] = {
    {EOpClamp, O::clamp_f, O::clamp_i, O::clamp_u},
    {EOpMix, O::mix_f, no, no},
    {EOpSmoothStep, O::smoothstep, no, no},
    {EOpFma, O::fma, no, no},
};

template <std::size_t N>
const Row* find(const Row (&rows)[N], TOperator op) {
    const Row* found = std::find_if(rows, rows + N, [&](const Row& row) { return row.from == op; });
    return found == rows + N ? nullptr : found;
}

Operation choose(const Row& row, TBasicType base) {
    return base == EbtFloat ? row.f : base == EbtInt ? row.i : base == EbtUint ? row.u : no;
}

/// a += b is a = a + b; EOpNull for what is no assignment.
TOperator operation_of_assignment(TOperator op) {
    switch (op) {
        case EOpAddAssign:
            return EOpAdd;
        case EOpSubAssign:
            return EOpSub;
        case EOpMulAssign:
            return EOpMul;
        case EOpVectorTimesMatrixAssign:
            return EOpVectorTimesMatrix;
        case EOpVectorTimesScalarAssign:
            return EOpVectorTimesScalar;
        case EOpMatrixTimesScalarAssign:
            return EOpMatrixTimesScalar;
        case EOpMatrixTimesMatrixAssign:
            return EOpMatrixTimesMatrix;
        case EOpDivAssign:
            return EOpDiv;
        case EOpModAssign:
            return EOpMod;
        case EOpAndAssign:
            return EOpAnd;
        case EOpInclusiveOrAssign:
            return EOpInclusiveOr;
        case EOpExclusiveOrAssign:
            return EOpExclusiveOr;
        case EOpLeftShiftAssign:
            return EOpLeftShift;
        case EOpRightShiftAssign:
            return EOpRightShift;
        default:
            return EOpNull;
    }
}

/// The variables and the calls of a function.
class Contents : public TIntermTraverser {
public:
    void visitSymbol(TIntermSymbol* symbol) override { symbols.push_back(symbol); }
    bool visitAggregate(TVisit, TIntermAggregate* node) override {
        if (node->getOp() == EOpFunctionCall) calls.push_back(node);
        return true;
    }
    std::vector<TIntermSymbol*> symbols;
    std::vector<TIntermAggregate*> calls;
};

class Compiler {
public:
    Compiler(const std::vector<CustomInput>& inputs, std::vector<CodeError>& errors)
        : errors_(errors), ranges_(inputs) {
        for (const CustomInput& input : inputs) {
            inputs_.emplace(input.name, program_.cells);
            program_.cells += input.cells;
        }
    }

    CustomProgram compile(TIntermNode* root) {
        TIntermAggregate* all = root ? root->getAsAggregate() : nullptr;
        // A text of one function may come without the sequence around it.
        TIntermSequence alone(1, root);
        for (TIntermNode* node : all && all->getOp() != EOpFunction ? all->getSequence() : alone)
            if (TIntermAggregate* a = node ? node->getAsAggregate() : nullptr; a && a->getOp() == EOpFunction)
                functions_[a->getName().c_str()].node = a;
        for (auto& [name, f] : functions_) attempt(f);
        if (!errors_.empty()) return {};
        const auto entry = functions_.find("sdf(vf3;");
        if (entry == functions_.end() || entry->second.result.base != EbtFloat || entry->second.result.cells != 1) {
            errors_.push_back({1, "there is no float sdf(vec3 p)"});
            return {};
        }
        check_entry(entry->second);
        std::reverse(program_.constants.begin(), program_.constants.end());
        return std::move(program_);
    }

private:
    using Labels = std::vector<std::size_t>;

    void attempt(Function& f) {
        try {
            function(f);
        } catch (const Refused& refused) {
            f.state = Function::broken;
            errors_.push_back({refused.line, refused.what()});
        } catch (const CallsBroken&) {
            f.state = Function::broken;
        }
    }

    void check_entry(const Function& f) {
        const int line = line_of(f.node);
        program_.entry = f.start;
        program_.point = f.parameters[0].at;
        program_.result = f.result.at;
        program_.repetitions = static_cast<std::uint64_t>(std::min(f.repetitions, most_repetitions));
        TIntermNode* point = f.node->getSequence()[0]->getAsAggregate()->getSequence()[0];
        const TStorageQualifier storage = point->getAsTyped()->getQualifier().storage;
        if (storage == EvqOut || storage == EvqInOut)
            errors_.push_back({line, "the parameter of sdf must not be out or inout"});
        if (f.repetitions > most_repetitions)
            errors_.push_back({line, fmt::format("one evaluation takes up to {:.0f} steps of loops, at most {:.0f} are "
                                                 "allowed",
                                                 f.repetitions, most_repetitions)});
        else if (f.operations > most_operations)
            errors_.push_back({line, fmt::format("one evaluation takes up to {:.0f} operations, at most {:.0f} are "
                                                 "allowed",
                                                 f.operations, most_operations)});
        else if (f.inlined > longest_inlined)
            errors_.push_back({line, fmt::format("with all calls inlined sdf has {:.0f} operations, at most {:.0f} are "
                                                 "allowed",
                                                 f.inlined, longest_inlined)});
    }

    // ---- functions -------------------------------------------------------------------------------------------------

    void function(Function& f) {
        if (f.state != Function::unknown) return;
        f.state = Function::open;
        breaks_.clear(), continues_.clear();
        Contents contents;
        f.node->traverse(&contents);
        for (TIntermAggregate* call : contents.calls) {
            Function& callee = called(call);
            if (callee.state == Function::open)
                refuse(line_of(call), "a function must not call itself, directly or through others");
            attempt(callee);
            if (callee.state == Function::broken) throw CallsBroken();
            f.depth = std::max(f.depth, callee.depth + 1);
        }
        if (f.depth > deepest_call)
            refuse(line_of(f.node), fmt::format("more than {} calls inside one another", deepest_call));
        for (TIntermSymbol* symbol : contents.symbols)
            if (!symbol->getName().empty()) variable(symbol);
        for (TIntermNode* node : f.node->getSequence())
            if (TIntermAggregate* part = node ? node->getAsAggregate() : nullptr;
                part && part->getOp() == EOpParameters)
                for (TIntermNode* p : part->getSequence()) f.parameters.push_back(variable(p->getAsSymbolNode()));
        f.result = {allocate(f.node->getType(), line_of(f.node)), 0, f.node->getBasicType()};
        f.result.cells = program_.cells - f.result.at;
        if (f.node->getBasicType() == EbtVoid) f.result.cells = 0;

        current_ = &f;
        first_temporary_ = next_temporary_ = program_.cells;
        factor_ = 1.0;
        f.start = static_cast<int>(program_.instructions.size());
        for (TIntermNode* node : f.node->getSequence()) {
            TIntermAggregate* part = node ? node->getAsAggregate() : nullptr;
            if (!part || part->getOp() != EOpParameters) statement(node);
        }
        emit({.operation = O::return_});
        f.state = Function::done;
    }

    Function& called(TIntermAggregate* call) {
        const auto found = functions_.find(call->getName().c_str());
        if (found == functions_.end()) {
            const std::string name = call->getName().c_str();
            refuse(line_of(call), fmt::format("the function {} has no body", name.substr(0, name.find('('))));
        }
        return found->second;
    }

    Value variable(TIntermSymbol* symbol) {
        const TType& type = symbol->getType();
        const TBasicType base = type.getBasicType();
        const int cells = cells_of(type, line_of(symbol));
        if (type.getQualifier().storage == EvqUniform) {
            const auto found = inputs_.find(symbol->getName().c_str());
            if (found != inputs_.end()) return {found->second, cells, base};
        }
        if (type.getQualifier().builtIn != EbvNone || type.getQualifier().storage == EvqUniform)
            refuse(line_of(symbol), fmt::format("{} is not available in distance code", symbol->getName().c_str()));
        if (symbol->getName().empty()) return {allocate(type, line_of(symbol)), cells, base};  // has no id of its own
        const auto [place, fresh] = variables_.try_emplace(symbol->getId(), program_.cells);
        if (fresh) allocate(type, line_of(symbol));
        return {place->second, cells, base};
    }

    int allocate(const TType& type, int line) {
        const int at = program_.cells;
        program_.cells += cells_of(type, line);
        check_size(line);
        return at;
    }

    void check_size(int line) const {
        if (program_.cells > most_cells || program_.constants.size() > most_cells)
            refuse(line, fmt::format("variables and constants take more than {} numbers", most_cells));
    }

    // ---- instructions ----------------------------------------------------------------------------------------------

    std::size_t emit(const Instruction& instruction) {
        program_.instructions.push_back(instruction);
        current_->operations += factor_;
        current_->inlined += 1.0;
        return program_.instructions.size() - 1;
    }
    int here() const { return static_cast<int>(program_.instructions.size()); }
    void land(const Labels& jumps) {
        for (const std::size_t jump : jumps) program_.instructions[jump].c = here();
    }

    /// Temporaries lie after the variables of their function and are free again after each statement.
    Value temporary(int cells, TBasicType base) {
        const Value value{next_temporary_, cells, base};
        next_temporary_ += cells;
        program_.cells = std::max(program_.cells, next_temporary_);
        check_size(statement_line_);
        return value;
    }

    Value constant(const std::vector<Cell>& cells, TBasicType base) {
        const auto [place, fresh] = constants_.try_emplace(cells, 0);
        if (fresh) {
            program_.constants.insert(program_.constants.end(), cells.rbegin(), cells.rend());
            place->second = -static_cast<int>(program_.constants.size());
            check_size(statement_line_);
        }
        return {place->second, static_cast<int>(cells.size()), base};
    }
    Value constant(float v) { return constant({std::bit_cast<Cell>(v)}, EbtFloat); }
    Value constant(TBasicType base, int v) {
        return base == EbtFloat ? constant(static_cast<float>(v)) : constant({static_cast<Cell>(v)}, base);
    }

    Value componentwise(Operation operation, const std::vector<Value>& args, TBasicType base) {
        int n = 1;
        for (const Value& v : args) n = std::max(n, v.cells);
        const Value result = temporary(n, base);
        Instruction in{.operation = operation, .n = static_cast<std::uint16_t>(n), .result = result.at};
        const auto step = [&](const Value& v) { return static_cast<std::uint8_t>(v.cells == 1 ? 0 : 1); };
        in.a = args[0].at, in.step_a = step(args[0]);
        if (args.size() > 1) in.b = args[1].at, in.step_b = step(args[1]);
        if (args.size() > 2) in.c = args[2].at, in.step_c = step(args[2]);
        emit(in);
        return result;
    }

    void move(int to, int from, int cells) {
        if (to != from && cells > 0)
            emit({.operation = O::move, .n = static_cast<std::uint16_t>(cells), .result = to, .a = from});
    }

    Value copy(const Value& value) {
        const Value result = temporary(value.cells, value.base);
        move(result.at, value.at, value.cells);
        return result;
    }

    // ---- places ----------------------------------------------------------------------------------------------------

    static int packed(const std::vector<int>& selectors) {
        int all = 0;
        for (std::size_t i = 0; i < selectors.size(); ++i) all |= selectors[i] << 8 * i;
        return all;
    }

    Value load(const Place& p) {
        if (p.selectors.empty() && p.offset == no_offset) return p.value;
        const Value result = temporary(p.value.cells, p.value.base);
        const auto n = static_cast<std::uint16_t>(result.cells);
        emit({.operation = p.selectors.empty() ? O::load : O::gather,
              .n = n,
              .result = result.at,
              .a = p.value.at,
              .b = p.offset,
              .c = packed(p.selectors)});
        return result;
    }

    void store(const Place& p, Value value) {
        const bool whole = p.selectors.empty() && p.offset == no_offset;
        // As in v.xy = v.yx, where each component must be read before it is overwritten.
        const bool apart = value.at + value.cells <= p.value.at || p.value.at + 4 <= value.at;
        if (value.at >= 0 && value.at < first_temporary_ && !(apart && p.value.cells <= 4 && p.offset == no_offset))
            value = copy(value);
        if (whole) return move(p.value.at, value.at, p.value.cells);
        emit({.operation = p.selectors.empty() ? O::store : O::scatter,
              .n = static_cast<std::uint16_t>(p.value.cells),
              .result = p.value.at,
              .a = value.at,
              .b = p.offset,
              .c = packed(p.selectors)});
    }

    Place place(TIntermTyped* node) {
        if (TIntermSymbol* symbol = node->getAsSymbolNode()) return {variable(symbol)};
        TIntermBinary* binary = node->getAsBinaryNode();
        if (!binary) return {expression(node)};
        TIntermTyped* left = binary->getLeft();
        TIntermTyped* right = binary->getRight();
        switch (binary->getOp()) {
            case EOpVectorSwizzle: {
                std::vector<int> selectors;
                for (TIntermNode* s : right->getAsAggregate()->getSequence())
                    selectors.push_back(s->getAsConstantUnion()->getConstArray()[0].getIConst());
                return picked(place(left), selectors);
            }
            case EOpIndexDirectStruct: {
                Place p = place(left);
                const int member = right->getAsConstantUnion()->getConstArray()[0].getIConst();
                const TTypeList& members = *left->getType().getStruct();
                for (int i = 0; i < member; ++i) p.value.at += cells_of(*members[i].type, line_of(node));
                return narrowed(p, node->getType(), line_of(node));
            }
            case EOpIndexDirect:
            case EOpIndexIndirect:
                return element(place_kept(left, right), left->getType(), right, node);
            default:
                return {expression(node)};
        }
    }

    /// The place of `node`; where it is a value that `later` could change, a copy of it.
    Place place_kept(TIntermTyped* node, TIntermTyped* later) {
        Place p = place(node);
        if (p.offset != no_offset && has_effects(later)) p.offset = copy({p.offset, 1, EbtInt}).at;
        return p;
    }

    static Place narrowed(Place p, const TType& type, int line) {
        p.value.cells = cells_of(type, line);
        p.value.base = type.getBasicType();
        return p;
    }

    static Place picked(Place p, std::vector<int> selectors) {
        for (int& s : selectors) s = p.selectors.empty() ? s : p.selectors[static_cast<std::size_t>(s)];
        p.value.cells = static_cast<int>(selectors.size());
        bool adjacent = true;
        for (std::size_t i = 1; i < selectors.size(); ++i) adjacent = adjacent && selectors[i] == selectors[i - 1] + 1;
        if (adjacent) p.value.at += selectors[0], selectors.clear();
        p.selectors = std::move(selectors);
        return p;
    }

    Place element(Place p, const TType& type, TIntermTyped* index, TIntermTyped* node) {
        const int line = line_of(node);
        const int cells = cells_of(node->getType(), line);
        const int count = cells_of(type, line) / std::max(cells, 1);
        const Range range = ranges_.of(index);
        if (!(range.low >= 0.0 && range.high <= count - 1))
            refuse(line,
                   fmt::format("this index may be beyond 0 .. {0}; limit it, as in a[clamp(i, 0, {0})]", count - 1));
        if (range.low == range.high) {
            const int i = static_cast<int>(range.low);
            if (!p.selectors.empty()) return picked(p, {i});
            p.value.at += i * cells;
            return narrowed(p, node->getType(), line);
        }
        if (!p.selectors.empty()) {
            p = {load(p)};  // of no use as the target of an assignment, and glslang refuses that
        }
        const Value i = expression(index);
        const Value offset = temporary(1, EbtInt);
        emit({.operation = O::index,
              .n = static_cast<std::uint16_t>(count),
              .result = offset.at,
              .a = i.at,
              .b = p.offset,
              .c = cells});
        p.offset = offset.at;
        return narrowed(p, node->getType(), line);
    }

    // ---- expressions -----------------------------------------------------------------------------------------------

    Value expression(TIntermTyped* node) {
        if (TIntermConstantUnion* c = node->getAsConstantUnion()) return literal(c);
        if (TIntermSymbol* symbol = node->getAsSymbolNode()) return variable(symbol);
        if (TIntermSelection* selection = node->getAsSelectionNode()) return alternative(selection);
        if (TIntermUnary* unary = node->getAsUnaryNode()) return unary_expression(unary);
        if (TIntermBinary* binary = node->getAsBinaryNode()) return binary_expression(binary);
        if (TIntermAggregate* aggregate = node->getAsAggregate()) {
            if (aggregate->getOp() == EOpFunctionCall) return call(aggregate);
            if (aggregate->getOp() == EOpModf) return modf(aggregate);
            if (aggregate->getOp() == EOpComma) {
                Value last;
                for (TIntermNode* part : aggregate->getSequence()) last = expression(part->getAsTyped());
                return last;
            }
            return apply(aggregate->getOp(), values(aggregate->getSequence()), *node);
        }
        unsupported(node);
    }

    [[noreturn]] void unsupported(TIntermNode* node) const {
        refuse(line_of(node), "this uses an operation or a function that is not available in distance code");
    }

    Value literal(TIntermConstantUnion* node) {
        const TConstUnionArray& array = node->getConstArray();
        std::vector<Cell> cells;  // glslang keeps floats as doubles
        for (int i = 0; i < array.size(); ++i) {
            const TConstUnion& c = array[i];
            cells.push_back(c.getType() == EbtDouble ? std::bit_cast<Cell>(static_cast<float>(c.getDConst()))
                            : c.getType() == EbtInt  ? static_cast<Cell>(c.getIConst())
                            : c.getType() == EbtUint ? c.getUConst()
                                                     : static_cast<Cell>(c.getBConst()));
        }
        if (static_cast<int>(cells.size()) != cells_of(node->getType(), line_of(node))) unsupported(node);
        return constant(cells, node->getBasicType());
    }

    /// Operands from left to right; what a later one might change is copied first.
    std::vector<Value> values(std::span<TIntermNode* const> nodes) {
        std::vector<Value> all;
        std::size_t last_effect = 0;
        for (std::size_t i = 0; i < nodes.size(); ++i)
            if (has_effects(nodes[i])) last_effect = i;
        for (std::size_t i = 0; i < nodes.size(); ++i) {
            Value v = expression(nodes[i]->getAsTyped());
            all.push_back(i < last_effect ? copy(v) : v);
        }
        return all;
    }

    Value alternative(TIntermSelection* node) {
        const Value result = temporary(cells_of(node->getType(), line_of(node)), node->getBasicType());
        const Value condition = expression(node->getCondition());
        const std::size_t to_else = emit({.operation = O::jump_if_false, .a = condition.at});
        move(result.at, expression(node->getTrueBlock()->getAsTyped()).at, result.cells);
        const std::size_t to_end = emit({.operation = O::jump});
        land({to_else});
        move(result.at, expression(node->getFalseBlock()->getAsTyped()).at, result.cells);
        land({to_end});
        return result;
    }

    Value unary_expression(TIntermUnary* node) {
        const TOperator op = node->getOp();
        if (op == EOpPostIncrement || op == EOpPostDecrement || op == EOpPreIncrement || op == EOpPreDecrement) {
            const Place p = place(node->getOperand());
            Value before = load(p);
            const bool adds = op == EOpPostIncrement || op == EOpPreIncrement;
            const bool after = op == EOpPostIncrement || op == EOpPostDecrement;
            if (after) before = copy(before);
            const Value v = arithmetic(adds ? EOpAdd : EOpSub, {before, constant(before.base, 1)}, node);
            store(p, v);
            return after ? before : v;
        }
        return apply(op, {expression(node->getOperand())}, *node);
    }

    Value binary_expression(TIntermBinary* node) {
        const TOperator op = node->getOp();
        TIntermTyped* left = node->getLeft();
        TIntermTyped* right = node->getRight();
        switch (op) {
            case EOpVectorSwizzle:
            case EOpIndexDirect:
            case EOpIndexIndirect:
            case EOpIndexDirectStruct:
                return load(place(node));
            case EOpLogicalAnd:
            case EOpLogicalOr: {
                const Value result = copy(expression(left));
                const Value test = op == EOpLogicalAnd ? result : componentwise(O::not_b, {result}, EbtBool);
                const std::size_t skip = emit({.operation = O::jump_if_false, .a = test.at});
                move(result.at, expression(right).at, 1);
                land({skip});
                return result;
            }
            case EOpAssign: {
                const Place p = place_kept(left, right);
                const Value v = expression(right);
                store(p, v);
                return v;
            }
            default:
                break;
        }
        if (const TOperator operation = operation_of_assignment(op); operation != EOpNull) {
            const Place p = place_kept(left, right);
            const bool effects = has_effects(right);
            Value before = load(p);
            if (effects) before = copy(before);
            const Value v = apply(operation, {before, expression(right)}, *node);
            store(p, v);
            return v;
        }
        TIntermNode* const operands[] = {left, right};
        return apply(op, values(operands), *node);
    }

    Value modf(TIntermAggregate* node) {
        const Value x = expression(node->getSequence()[0]->getAsTyped());
        const Value whole = componentwise(O::trunc, {x}, EbtFloat);
        const Value fraction = componentwise(O::subtract_f, {x, whole}, EbtFloat);
        store(place(node->getSequence()[1]->getAsTyped()), whole);
        return fraction;
    }

    Value call(TIntermAggregate* node) {
        Function& f = called(node);
        const TIntermSequence& arguments = node->getSequence();
        std::vector<Value> in(arguments.size());
        std::vector<Place> out(arguments.size());
        for (std::size_t i = 0; i < arguments.size(); ++i) {
            TIntermTyped* argument = arguments[i]->getAsTyped();
            const TStorageQualifier storage = node->getQualifierList()[i];
            if (storage == EvqOut || storage == EvqInOut) {
                out[i] = place(argument);
                if (storage == EvqInOut) in[i] = copy(load(out[i]));
            } else {
                in[i] = copy(expression(argument));
            }
        }
        for (std::size_t i = 0; i < in.size(); ++i) move(f.parameters[i].at, in[i].at, in[i].cells);
        emit({.operation = O::call, .c = f.start});
        current_->operations += factor_ * f.operations;
        current_->repetitions += factor_ * f.repetitions;
        current_->inlined += f.inlined;
        const Value result = copy(f.result);
        for (std::size_t i = 0; i < out.size(); ++i)
            if (out[i].value.cells > 0) store(out[i], f.parameters[i]);
        return result;
    }

    Value apply(TOperator op, const std::vector<Value>& args, TIntermTyped& node) {
        const TType& type = node.getType();
        const int cells = cells_of(type, line_of(&node));
        if (op > EOpConstructGuardStart && op < EOpConstructGuardEnd) return construct(type, args, node);
        if (op >= EOpConvInt8ToBool && op <= EOpConvDoubleToFloat) return converted(args[0], type.getBasicType());
        switch (op) {
            case EOpLogicalNot:
            case EOpVectorLogicalNot:
                return componentwise(O::not_b, args, EbtBool);
            case EOpLogicalXor:
                return componentwise(O::xor_i, args, EbtBool);
            case EOpFloatBitsToInt:
            case EOpFloatBitsToUint:
            case EOpIntBitsToFloat:
            case EOpUintBitsToFloat:
                return {args[0].at, args[0].cells, type.getBasicType()};
            case EOpEqual:
            case EOpNotEqual:
                return equality(op == EOpEqual, args, node);
            case EOpVectorEqual:
            case EOpVectorNotEqual:
                if (args[0].base == EbtBool)
                    return componentwise(op == EOpVectorEqual ? O::equal_i : O::not_equal_i, args, EbtBool);
                break;
            case EOpMix:
                if (args[2].base == EbtBool) return componentwise(O::select, args, type.getBasicType());
                break;
            case EOpAny:
                return whole(O::any, args, {args[0].cells, 1, EbtBool});
            case EOpAll:
                return whole(O::all, args, {args[0].cells, 1, EbtBool});
            case EOpDot:
                return whole(O::dot, args, {args[0].cells, 1, EbtFloat});
            case EOpLength:
                return whole(O::length, args, {args[0].cells, 1, EbtFloat});
            case EOpDistance:
                return whole(O::length, {componentwise(O::subtract_f, args, EbtFloat)}, {args[0].cells, 1, EbtFloat});
            case EOpNormalize:
                return whole(O::normalize, args, {cells, cells, EbtFloat});
            case EOpCross:
                return whole(O::cross, args, {cells, cells, EbtFloat});
            case EOpFaceForward:  // (n, i, reference): n, turned against i
                return whole(O::faceforward, args, {cells, cells, EbtFloat});
            case EOpReflect:
                return whole(O::reflect, args, {cells, cells, EbtFloat});
            case EOpRefract:
                return whole(O::refract, args, {cells, cells, EbtFloat});
            case EOpMatrixTimesVector:
                return matrix(O::matrix_product, args, cells, 1, args[1].cells);
            case EOpVectorTimesMatrix:
                return matrix(O::matrix_product, args, 1, cells, args[0].cells);
            case EOpMatrixTimesMatrix:
                return matrix(O::matrix_product, args, type.getMatrixRows(), type.getMatrixCols(),
                              args[0].cells / type.getMatrixRows());
            case EOpOuterProduct:
                return matrix(O::outer_product, args, type.getMatrixRows(), type.getMatrixCols(), 1);
            case EOpTranspose:
                return matrix(O::transpose, args, type.getMatrixRows(), type.getMatrixCols(), 1);
            case EOpDeterminant:
                return matrix(O::determinant, args, 1, 1, args[0].cells == 4 ? 2 : args[0].cells == 9 ? 3 : 4);
            case EOpMatrixInverse:
                return matrix(O::inverse, args, type.getMatrixRows(), type.getMatrixCols(), type.getMatrixCols());
            default:
                break;
        }
        return arithmetic(op, args, &node);
    }

    Value arithmetic(TOperator op, const std::vector<Value>& args, TIntermTyped* node) {
        const Row* row = args.size() == 1   ? find(unary_rows, op)
                         : args.size() == 2 ? find(binary_rows, op)
                         : args.size() == 3 ? find(ternary_rows, op)
                                            : nullptr;
        const Operation operation = row ? choose(*row, args[0].base) : no;
        if (operation == no) unsupported(node);
        return componentwise(operation, row->swapped ? std::vector<Value>{args[1], args[0]} : args,
                             node->getBasicType());
    }

    struct Shape {
        int n, cells;
        TBasicType base;
    };
    Value whole(Operation operation, const std::vector<Value>& args, const Shape& shape) {
        const Value result = temporary(shape.cells, shape.base);
        emit({.operation = operation,
              .n = static_cast<std::uint16_t>(shape.n),
              .result = result.at,
              .a = args[0].at,
              .b = args.size() > 1 ? args[1].at : 0,
              .c = args.size() > 2 ? args[2].at : 0});
        return result;
    }

    Value matrix(Operation operation, const std::vector<Value>& args, int rows, int columns, int n) {
        const Value result = temporary(rows * columns, EbtFloat);
        emit({.operation = operation,
              .rows = static_cast<std::uint8_t>(rows),
              .columns = static_cast<std::uint8_t>(columns),
              .n = static_cast<std::uint16_t>(n),
              .result = result.at,
              .a = args[0].at,
              .b = args.size() > 1 ? args[1].at : 0});
        return result;
    }

    Value equality(bool equal, const std::vector<Value>& args, TIntermTyped& node) {
        TIntermBinary* binary = node.getAsBinaryNode();
        if (!binary) unsupported(&node);
        Value result = constant({1u}, EbtBool);
        int at = 0;
        compare(binary->getLeft()->getType(), args[0].at, args[1].at, at, result, line_of(&node));
        return equal ? result : componentwise(O::not_b, {result}, EbtBool);
    }

    /// Adds to `result` whether the values of one type at a + at and b + at are equal; floats compare as numbers.
    void compare(const TType& type, int a, int b, int& at, Value& result, int line) {
        if (type.isStruct()) {
            const int count = type.isArray() ? type.getCumulativeArraySize() : 1;
            for (int i = 0; i < count; ++i)
                for (const TTypeLoc& member : *type.getStruct()) compare(*member.type, a, b, at, result, line);
            return;
        }
        const int cells = cells_of(type, line);
        const TBasicType base = type.getBasicType();
        const Value same = componentwise(base == EbtFloat ? O::equal_f : O::equal_i,
                                         {{a + at, cells, base}, {b + at, cells, base}}, EbtBool);
        at += cells;
        result = componentwise(O::and_i, {result, whole(O::all, {same}, {cells, 1, EbtBool})}, EbtBool);
    }

    Value converted(const Value& v, TBasicType to) {
        Value result{v.at, v.cells, to};
        if (v.base == to) return result;
        if (to == EbtFloat) return componentwise(v.base == EbtInt ? O::int_to_float : O::uint_to_float, {v}, to);
        if (to == EbtBool) return componentwise(v.base == EbtFloat ? O::float_to_bool : O::int_to_bool, {v}, to);
        if (v.base == EbtFloat) return componentwise(to == EbtInt ? O::float_to_int : O::float_to_uint, {v}, to);
        return result;  // int, uint and bool share their bits
    }

    Value construct(const TType& type, std::vector<Value> args, TIntermTyped& node) {
        const int cells = cells_of(type, line_of(&node));
        const TBasicType base = type.getBasicType();
        const Value result = temporary(cells, base);
        if (!type.isArray() && !type.isStruct()) {
            for (Value& v : args) v = converted(v, base);
            if (args.size() == 1 && type.isMatrix()) return matrix_of(type, args[0], node, result);
            if (args.size() == 1 && args[0].cells == 1) {
                for (int i = 0; i < cells; ++i) move(result.at + i, args[0].at, 1);
                return result;
            }
        }
        int filled = 0;
        for (const Value& v : args) {
            const int n = std::min(v.cells, cells - filled);
            move(result.at + filled, v.at, n);
            filled += n;
        }
        if (filled != cells) unsupported(&node);
        return result;
    }

    /// From a scalar: on the diagonal; from a matrix: its upper left part, the identity beyond it.
    Value matrix_of(const TType& type, const Value& v, TIntermTyped& node, const Value& result) {
        const int rows = type.getMatrixRows(), columns = type.getMatrixCols();
        int from_rows = 0, from_columns = 0;
        if (v.cells > 1) {
            TIntermTyped* from = node.getAsUnaryNode() ? node.getAsUnaryNode()->getOperand()
                                                       : node.getAsAggregate()->getSequence()[0]->getAsTyped();
            from_rows = from->getMatrixRows(), from_columns = from->getMatrixCols();
            if (from_columns == 0) {  // a vector of four gives a mat2
                if (v.cells < rows * columns) unsupported(&node);
                move(result.at, v.at, rows * columns);
                return result;
            }
        }
        const Value zero = constant(0.0f), diagonal = v.cells == 1 ? v : constant(1.0f);
        for (int column = 0; column < columns; ++column)
            for (int row = 0; row < rows; ++row) {
                const bool inside = column < from_columns && row < from_rows;
                const int from = inside ? v.at + column * from_rows + row : row == column ? diagonal.at : zero.at;
                move(result.at + column * rows + row, from, 1);
            }
        return result;
    }

    // ---- statements ------------------------------------------------------------------------------------------------

    void statement(TIntermNode* node) {
        if (!node) return;
        statement_line_ = std::max(1, line_of(node));
        const int free = next_temporary_;
        if (TIntermSelection* selection = node->getAsSelectionNode(); selection && selection->getBasicType() == EbtVoid)
            choice(selection);
        else if (TIntermSwitch* cases = node->getAsSwitchNode())
            switch_statement(cases);
        else if (TIntermBranch* branch = node->getAsBranchNode())
            branch_statement(branch);
        else if (node->getAsLoopNode())
            loop(node->getAsLoopNode(), nullptr);
        else if (TIntermAggregate* a = node->getAsAggregate();
                 a && (a->getOp() == EOpSequence || a->getOp() == EOpScope))
            sequence(a);
        else if (TIntermTyped* typed = node->getAsTyped())
            expression(typed);
        else
            unsupported(node);
        next_temporary_ = free;
    }

    void sequence(TIntermAggregate* node) {
        TIntermNode* before = nullptr;
        for (TIntermNode* child : node->getSequence()) {
            if (child && child->getAsLoopNode())
                loop(child->getAsLoopNode(), before);
            else
                statement(child);
            before = child;
        }
    }

    void choice(TIntermSelection* node) {
        const std::size_t to_else = emit({.operation = O::jump_if_false, .a = expression(node->getCondition()).at});
        statement(node->getTrueBlock());
        if (!node->getFalseBlock()) return land({to_else});
        const std::size_t to_end = emit({.operation = O::jump});
        land({to_else});
        statement(node->getFalseBlock());
        land({to_end});
    }

    void loop(TIntermLoop* node, TIntermNode* before) {
        if (!node->testFirst() || !node->getTest() || !node->getTerminal())
            refuse(line_of(node), "expected a loop as for (int i = 0; i < 8; ++i)");
        const LoopSteps steps = ranges_.steps(node, before, most_repetitions);
        const double outside = factor_;
        factor_ *= steps.count + 1.0;
        const int free = next_temporary_, start = here();
        const std::size_t leave = emit({.operation = O::jump_if_false, .a = expression(node->getTest()).at});
        next_temporary_ = free;
        factor_ = outside * steps.count;
        current_->repetitions += factor_;
        breaks_.emplace_back(), continues_.emplace_back();
        ranges_.enter(steps);
        statement(node->getBody());
        ranges_.leave(steps);
        land(continues_.back());
        expression(node->getTerminal());
        next_temporary_ = free;
        emit({.operation = O::repeat, .c = start});
        land({leave});
        land(breaks_.back());
        breaks_.pop_back(), continues_.pop_back();
        factor_ = outside;
    }

    void switch_statement(TIntermSwitch* node) {
        const Value selector = copy(expression(node->getCondition()->getAsTyped()));
        const TIntermSequence& body = node->getBody()->getSequence();
        std::map<TIntermNode*, std::size_t> jumps;
        std::size_t otherwise = 0;
        bool has_default = false;
        for (TIntermNode* child : body)
            if (TIntermBranch* b = child->getAsBranchNode(); b && b->getFlowOp() == EOpCase)
                jumps[child] =
                    emit({.operation = O::jump_if_equal, .a = selector.at, .b = expression(b->getExpression()).at});
        otherwise = emit({.operation = O::jump});
        breaks_.emplace_back();
        for (TIntermNode* child : body) {
            TIntermBranch* b = child->getAsBranchNode();
            if (b && b->getFlowOp() == EOpCase)
                land({jumps[child]});
            else if (b && b->getFlowOp() == EOpDefault)
                land({otherwise}), has_default = true;
            else
                statement(child);
        }
        if (!has_default) land({otherwise});
        land(breaks_.back());
        breaks_.pop_back();
    }

    void branch_statement(TIntermBranch* node) {
        switch (node->getFlowOp()) {
            case EOpReturn:
                if (node->getExpression())
                    move(current_->result.at, expression(node->getExpression()).at, current_->result.cells);
                emit({.operation = O::return_});
                break;
            case EOpBreak:
                breaks_.back().push_back(emit({.operation = O::jump}));
                break;
            case EOpContinue:
                continues_.back().push_back(emit({.operation = O::jump}));
                break;
            default:
                unsupported(node);
        }
    }

    std::vector<CodeError>& errors_;
    Ranges ranges_;
    CustomProgram program_;
    std::map<std::string, Function> functions_;  ///< by glslang's name, with the parameters' types
    std::map<std::string, int> inputs_;
    std::map<long long, int> variables_;
    std::map<std::vector<Cell>, int> constants_;
    Function* current_ = nullptr;
    double factor_ = 1.0;  ///< how often the code that is being compiled runs in one call of its function
    int first_temporary_ = 0, next_temporary_ = 0;  ///< of the current function
    int statement_line_ = 1;
    std::vector<Labels> breaks_, continues_;
};

}  // namespace

CustomProgram compile_custom(TIntermNode* root, const std::vector<CustomInput>& inputs,
                             std::vector<CodeError>& errors) {
    return Compiler(inputs, errors).compile(root);
}

}  // namespace farfield
