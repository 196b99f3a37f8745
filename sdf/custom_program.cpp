#include "sdf/custom_program.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>

namespace farfield {
namespace {

template <class T>
T get(Cell c) {
    return std::bit_cast<T>(c);
}
Cell put(float v) { return std::bit_cast<Cell>(v); }
Cell put(std::int32_t v) { return static_cast<Cell>(v); }
Cell put(std::int64_t v) { return static_cast<Cell>(v); }
Cell put(Cell v) { return v; }
Cell put(bool v) { return v ? 1u : 0u; }

template <class T>
T to_integer(float x) {
    constexpr float end = 2.0f * static_cast<float>(std::numeric_limits<T>::max() / 2 + 1);
    if (!(x > static_cast<float>(std::numeric_limits<T>::min())))
        return std::isnan(x) ? T{0} : std::numeric_limits<T>::min();
    return x < end ? static_cast<T>(x) : std::numeric_limits<T>::max();
}

float smooth_step(float low, float high, float x) {
    const float t = std::fmin(std::fmax((x - low) / (high - low), 0.0f), 1.0f);
    return t * t * (3.0f - 2.0f * t);
}

/// Operands as floats.
struct Floats {
    const Cell* cells;
    float operator[](int i) const { return get<float>(cells[i]); }
};

float dot(Floats a, Floats b, int n) {
    float sum = a[0] * b[0];
    for (int i = 1; i < n; ++i) sum += a[i] * b[i];
    return sum;
}

/// By elimination without a pivot in sight for n <= 4: cofactors along the first column.
float determinant(const std::array<float, 16>& m, int n) {
    if (n == 1) return m[0];
    if (n == 2) return m[0] * m[3] - m[2] * m[1];
    float sum = 0.0f;
    for (int skipped = 0; skipped < n; ++skipped) {
        std::array<float, 16> minor{};
        for (int column = 1; column < n; ++column)
            for (int row = 0, to = 0; row < n; ++row)
                if (row != skipped) minor[(column - 1) * (n - 1) + to++] = m[column * n + row];
        sum += (skipped % 2 ? -1.0f : 1.0f) * m[skipped] * determinant(minor, n - 1);
    }
    return sum;
}

std::array<float, 16> square_matrix(Floats a, int n) {
    std::array<float, 16> m{};
    for (int i = 0; i < n * n; ++i) m[i] = a[i];
    return m;
}

/// The adjugate over the determinant.
void invert(Cell* result, Floats a, int n) {
    const std::array<float, 16> m = square_matrix(a, n);
    const float scale = 1.0f / determinant(m, n);
    for (int column = 0; column < n; ++column)
        for (int row = 0; row < n; ++row) {
            std::array<float, 16> minor{};
            int to = 0;
            for (int i = 0; i < n; ++i)
                for (int j = 0; j < n; ++j)
                    if (i != row && j != column) minor[to++] = m[i * n + j];
            result[column * n + row] = put(((row + column) % 2 ? -scale : scale) * determinant(minor, n - 1));
        }
}

void vector_operation(const Instruction& in, Cell* r, Floats a, Floats b, Floats c) {
    const int n = in.n;
    switch (in.operation) {
        case Operation::dot:
            r[0] = put(dot(a, b, n));
            break;
        case Operation::length:
            r[0] = put(n == 1 ? std::fabs(a[0]) : std::sqrt(dot(a, a, n)));
            break;
        case Operation::normalize: {
            const float scale = 1.0f / std::sqrt(dot(a, a, n));
            for (int i = 0; i < n; ++i) r[i] = put(a[i] * scale);
            break;
        }
        case Operation::cross:
            for (int i = 0; i < 3; ++i) {
                const int j = (i + 1) % 3, k = (i + 2) % 3;
                r[i] = put(a[j] * b[k] - b[j] * a[k]);
            }
            break;
        case Operation::faceforward: {
            const bool keeps = dot(c, b, n) < 0.0f;
            for (int i = 0; i < n; ++i) r[i] = put(keeps ? a[i] : -a[i]);
            break;
        }
        case Operation::reflect: {
            const float twice = 2.0f * dot(b, a, n);
            for (int i = 0; i < n; ++i) r[i] = put(a[i] - twice * b[i]);
            break;
        }
        default: {  // refract
            const float eta = c[0], d = dot(b, a, n), k = 1.0f - eta * eta * (1.0f - d * d);
            for (int i = 0; i < n; ++i) r[i] = put(k < 0.0f ? 0.0f : eta * a[i] - (eta * d + std::sqrt(k)) * b[i]);
            break;
        }
    }
}

void matrix_operation(const Instruction& in, Cell* r, Floats a, Floats b) {
    const int rows = in.rows, columns = in.columns, n = in.n;
    switch (in.operation) {
        case Operation::matrix_product:
            for (int column = 0; column < columns; ++column)
                for (int row = 0; row < rows; ++row) {
                    float sum = a[row] * b[column * n];
                    for (int i = 1; i < n; ++i) sum += a[i * rows + row] * b[column * n + i];
                    r[column * rows + row] = put(sum);
                }
            break;
        case Operation::outer_product:
            for (int column = 0; column < columns; ++column)
                for (int row = 0; row < rows; ++row) r[column * rows + row] = put(a[row] * b[column]);
            break;
        case Operation::transpose:
            for (int column = 0; column < columns; ++column)
                for (int row = 0; row < rows; ++row) r[column * rows + row] = a.cells[row * columns + column];
            break;
        case Operation::determinant:
            r[0] = put(determinant(square_matrix(a, n), n));
            break;
        default:
            invert(r, a, n);
            break;
    }
}

}  // namespace

// A compiler's temporaries never overlap their operands, so results may be written before all operands are read.
float run(const CustomProgram& program, const float point[3], const Cell* inputs, int input_count) {
    thread_local std::vector<Cell> memory;
    const std::size_t constants = program.constants.size();
    memory.assign(constants + static_cast<std::size_t>(program.cells), 0u);
    std::copy(program.constants.begin(), program.constants.end(), memory.begin());
    Cell* const cells = memory.data() + constants;
    std::copy_n(inputs, input_count, cells);
    for (int i = 0; i < 3; ++i) cells[program.point + i] = put(point[i]);

    std::array<int, 64> returns{};
    int depth = 0;
    std::uint64_t repetitions = 0;
    for (int at = program.entry;;) {
        const Instruction& in = program.instructions[static_cast<std::size_t>(at++)];
        Cell* const r = cells + in.result;
        const Cell* const a = cells + in.a;
        const auto offset = [&] { return in.b == no_offset ? 0 : static_cast<int>(cells[in.b]); };
        switch (in.operation) {
#define FARFIELD_CASE(name, Result, Operand, value)           \
    case Operation::name:                                     \
        for (int i = 0; i < in.n; ++i) {                      \
            const Operand x = get<Operand>(a[i * in.step_a]); \
            r[i] = put(value);                                \
        }                                                     \
        break;
            FARFIELD_UNARY(FARFIELD_CASE)
#undef FARFIELD_CASE
#define FARFIELD_CASE(name, Result, Operand, value)                      \
    case Operation::name:                                                \
        for (int i = 0; i < in.n; ++i) {                                 \
            const Operand x = get<Operand>(a[i * in.step_a]);            \
            const Operand y = get<Operand>(cells[in.b + i * in.step_b]); \
            r[i] = put(value);                                           \
        }                                                                \
        break;
            FARFIELD_BINARY(FARFIELD_CASE)
#undef FARFIELD_CASE
#define FARFIELD_CASE(name, Result, Operand, value)                      \
    case Operation::name:                                                \
        for (int i = 0; i < in.n; ++i) {                                 \
            const Operand x = get<Operand>(a[i * in.step_a]);            \
            const Operand y = get<Operand>(cells[in.b + i * in.step_b]); \
            const Operand z = get<Operand>(cells[in.c + i * in.step_c]); \
            r[i] = put(value);                                           \
        }                                                                \
        break;
            FARFIELD_TERNARY(FARFIELD_CASE)
#undef FARFIELD_CASE
            case Operation::any:
                r[0] = std::any_of(a, a + in.n, [](Cell c) { return c != 0u; });
                break;
            case Operation::all:
                r[0] = std::all_of(a, a + in.n, [](Cell c) { return c != 0u; });
                break;
            case Operation::dot:
            case Operation::length:
            case Operation::normalize:
            case Operation::cross:
            case Operation::faceforward:
            case Operation::reflect:
            case Operation::refract:
                vector_operation(in, r, {a}, {cells + in.b}, {cells + in.c});
                break;
            case Operation::matrix_product:
            case Operation::outer_product:
            case Operation::transpose:
            case Operation::determinant:
            case Operation::inverse:
                matrix_operation(in, r, {a}, {cells + in.b});
                break;
            case Operation::move:
                std::copy_n(a, in.n, r);
                break;
            case Operation::gather:
                for (int i = 0, from = offset(); i < in.n; ++i) r[i] = a[from + (in.c >> 8 * i & 0xff)];
                break;
            case Operation::scatter:
                for (int i = 0, to = offset(); i < in.n; ++i) r[to + (in.c >> 8 * i & 0xff)] = a[i];
                break;
            case Operation::load:
                std::copy_n(a + offset(), in.n, r);
                break;
            case Operation::store:
                std::copy_n(a, in.n, r + offset());
                break;
            case Operation::index:
                r[0] = static_cast<Cell>(offset() + std::clamp(get<std::int32_t>(a[0]), 0, in.n - 1) * in.c);
                break;
            case Operation::jump:
                at = in.c;
                break;
            case Operation::jump_if_false:
                if (a[0] == 0u) at = in.c;
                break;
            case Operation::jump_if_equal:
                if (a[0] == cells[in.b]) at = in.c;
                break;
            case Operation::repeat:
                // The compiler has shown that it cannot be more; a mistake there must not hang the window.
                if (++repetitions > program.repetitions) return std::numeric_limits<float>::quiet_NaN();
                at = in.c;
                break;
            case Operation::call:
                returns[static_cast<std::size_t>(depth++)] = at;
                at = in.c;
                break;
            case Operation::return_:
                if (depth == 0) return get<float>(cells[program.result]);
                at = returns[static_cast<std::size_t>(--depth)];
                break;
        }
    }
}

}  // namespace farfield
