#include "sdf/custom_expressions.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>

namespace farfield::custom {
namespace {

/// One operation for each type of component.
struct Row {
    TOperator from;
    Operation f, i, u;
    bool swapped = false;
};
constexpr Operation no = Operation::return_;  // none for this type

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

}  // namespace

Function& Expressions::called(TIntermAggregate* call) {
    const auto found = functions_.find(call->getName().c_str());
    if (found == functions_.end()) {
        const std::string name = call->getName().c_str();
        refuse(line_of(call), fmt::format("the function {} has no body", name.substr(0, name.find('('))));
    }
    return found->second;
}

Value Expressions::variable(TIntermSymbol* symbol) {
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

Place Expressions::place(TIntermTyped* node) {
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

Place Expressions::place_kept(TIntermTyped* node, TIntermTyped* later) {
    Place p = place(node);
    if (p.offset != no_offset && has_effects(later)) p.offset = copy({p.offset, 1, EbtInt}).at;
    return p;
}

Place Expressions::element(Place p, const TType& type, TIntermTyped* index, TIntermTyped* node) {
    const int line = line_of(node);
    const int cells = cells_of(node->getType(), line);
    const int count = cells_of(type, line) / std::max(cells, 1);
    const Range range = ranges_.of(index);
    if (!(range.low >= 0.0 && range.high <= count - 1))
        refuse(line, fmt::format("this index may be beyond 0 .. {0}; limit it, as in a[clamp(i, 0, {0})]", count - 1));
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

Value Expressions::expression(TIntermTyped* node) {
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

void Expressions::unsupported(TIntermNode* node) const {
    refuse(line_of(node), "this uses an operation or a function that is not available in distance code");
}

Value Expressions::literal(TIntermConstantUnion* node) {
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

std::vector<Value> Expressions::values(std::span<TIntermNode* const> nodes) {
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

Value Expressions::alternative(TIntermSelection* node) {
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

Value Expressions::unary_expression(TIntermUnary* node) {
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

Value Expressions::binary_expression(TIntermBinary* node) {
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
            return store(p, expression(right));
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

Value Expressions::modf(TIntermAggregate* node) {
    const Value x = expression(node->getSequence()[0]->getAsTyped());
    const Value whole = componentwise(O::trunc, {x}, EbtFloat);
    const Value fraction = componentwise(O::subtract_f, {x, whole}, EbtFloat);
    store(place(node->getSequence()[1]->getAsTyped()), whole);
    return fraction;
}

Value Expressions::call(TIntermAggregate* node) {
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

Value Expressions::apply(TOperator op, const std::vector<Value>& args, TIntermTyped& node) {
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

Value Expressions::arithmetic(TOperator op, const std::vector<Value>& args, TIntermTyped* node) {
    const Row* row = args.size() == 1   ? find(unary_rows, op)
                     : args.size() == 2 ? find(binary_rows, op)
                     : args.size() == 3 ? find(ternary_rows, op)
                                        : nullptr;
    const Operation operation = row ? choose(*row, args[0].base) : no;
    if (operation == no) unsupported(node);
    return componentwise(operation, row->swapped ? std::vector<Value>{args[1], args[0]} : args, node->getBasicType());
}

Value Expressions::equality(bool equal, const std::vector<Value>& args, TIntermTyped& node) {
    TIntermBinary* binary = node.getAsBinaryNode();
    if (!binary) unsupported(&node);
    Value result = constant({1u}, EbtBool);
    int at = 0;
    compare(binary->getLeft()->getType(), args[0].at, args[1].at, at, result, line_of(&node));
    return equal ? result : componentwise(O::not_b, {result}, EbtBool);
}

Value Expressions::construct(const TType& type, std::vector<Value> args, TIntermTyped& node) {
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

Value Expressions::matrix_of(const TType& type, const Value& v, TIntermTyped& node, const Value& result) {
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

}  // namespace farfield::custom
