#include "sdf/custom_builder.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>

namespace farfield::custom {
namespace {

constexpr int most_cells = 4096;

}  // namespace

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

int Builder::allocate(const TType& type, int line) {
    const int at = program_.cells;
    program_.cells += cells_of(type, line);
    check_size(line);
    return at;
}

void Builder::check_size(int line) const {
    if (program_.cells > most_cells || program_.constants.size() > most_cells)
        refuse(line, fmt::format("variables and constants take more than {} numbers", most_cells));
}

std::size_t Builder::emit(const Instruction& instruction) {
    program_.instructions.push_back(instruction);
    current_->operations += factor_;
    current_->inlined += 1.0;
    return program_.instructions.size() - 1;
}

int Builder::here() const { return static_cast<int>(program_.instructions.size()); }

void Builder::land(const Labels& jumps) {
    for (const std::size_t jump : jumps) program_.instructions[jump].c = here();
}

Value Builder::temporary(int cells, TBasicType base) {
    const Value value{next_temporary_, cells, base};
    next_temporary_ += cells;
    program_.cells = std::max(program_.cells, next_temporary_);
    check_size(statement_line_);
    return value;
}

Value Builder::constant(const std::vector<Cell>& cells, TBasicType base) {
    const auto [place, fresh] = constants_.try_emplace(cells, 0);
    if (fresh) {
        program_.constants.insert(program_.constants.end(), cells.rbegin(), cells.rend());
        place->second = -static_cast<int>(program_.constants.size());
        check_size(statement_line_);
    }
    return {place->second, static_cast<int>(cells.size()), base};
}

Value Builder::constant(float v) { return constant({std::bit_cast<Cell>(v)}, EbtFloat); }

Value Builder::constant(TBasicType base, int v) {
    return base == EbtFloat ? constant(static_cast<float>(v)) : constant({static_cast<Cell>(v)}, base);
}

Value Builder::componentwise(Operation operation, const std::vector<Value>& args, TBasicType base) {
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

void Builder::move(int to, int from, int cells) {
    if (to != from && cells > 0)
        emit({.operation = O::move, .n = static_cast<std::uint16_t>(cells), .result = to, .a = from});
}

Value Builder::copy(const Value& value) {
    const Value result = temporary(value.cells, value.base);
    move(result.at, value.at, value.cells);
    return result;
}

int Builder::packed(const std::vector<int>& selectors) {
    int all = 0;
    for (std::size_t i = 0; i < selectors.size(); ++i) all |= selectors[i] << 8 * i;
    return all;
}

Value Builder::load(const Place& p) {
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

Value Builder::store(const Place& p, Value value) {
    const bool whole = p.selectors.empty() && p.offset == no_offset;
    // As in v.xy = v.yx, where each component must be read before it is overwritten.
    const bool apart = value.at + value.cells <= p.value.at || p.value.at + 4 <= value.at;
    if (value.at >= 0 && value.at < first_temporary_ && !(apart && p.value.cells <= 4 && p.offset == no_offset))
        value = copy(value);
    if (whole)
        move(p.value.at, value.at, p.value.cells);
    else
        emit({.operation = p.selectors.empty() ? O::store : O::scatter,
              .n = static_cast<std::uint16_t>(p.value.cells),
              .result = p.value.at,
              .a = value.at,
              .b = p.offset,
              .c = packed(p.selectors)});
    return value;
}

Place Builder::narrowed(Place p, const TType& type, int line) {
    p.value.cells = cells_of(type, line);
    p.value.base = type.getBasicType();
    return p;
}

Place Builder::picked(Place p, std::vector<int> selectors) {
    for (int& s : selectors) s = p.selectors.empty() ? s : p.selectors[static_cast<std::size_t>(s)];
    p.value.cells = static_cast<int>(selectors.size());
    bool adjacent = true;
    for (std::size_t i = 1; i < selectors.size(); ++i) adjacent = adjacent && selectors[i] == selectors[i - 1] + 1;
    if (adjacent) p.value.at += selectors[0], selectors.clear();
    p.selectors = std::move(selectors);
    return p;
}

Value Builder::whole(Operation operation, const std::vector<Value>& args, const Shape& shape) {
    const Value result = temporary(shape.cells, shape.base);
    emit({.operation = operation,
          .n = static_cast<std::uint16_t>(shape.n),
          .result = result.at,
          .a = args[0].at,
          .b = args.size() > 1 ? args[1].at : 0,
          .c = args.size() > 2 ? args[2].at : 0});
    return result;
}

Value Builder::matrix(Operation operation, const std::vector<Value>& args, int rows, int columns, int n) {
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

void Builder::compare(const TType& type, int a, int b, int& at, Value& result, int line) {
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

Value Builder::converted(const Value& v, TBasicType to) {
    Value result{v.at, v.cells, to};
    if (v.base == to) return result;
    if (to == EbtFloat) return componentwise(v.base == EbtInt ? O::int_to_float : O::uint_to_float, {v}, to);
    if (to == EbtBool) return componentwise(v.base == EbtFloat ? O::float_to_bool : O::int_to_bool, {v}, to);
    if (v.base == EbtFloat) return componentwise(to == EbtInt ? O::float_to_int : O::float_to_uint, {v}, to);
    return result;  // int, uint and bool share their bits
}

}  // namespace farfield::custom
