// Custom code as a register program for the CPU. Memory is one array of 32-bit cells: constants below address 0, the
// variables and temporaries of all functions above. There is no recursion, so each function has its place for good, and
// a call is a jump. Vectors, matrices (by columns), arrays and structures lie in consecutive cells; true is 1.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace farfield {

using Cell = std::uint32_t;

// Operations on each component: name, result type, operand type, value of x (y, z). The compiler, the interpreter and
// Operation itself are made from these tables. Where GLSL leaves the result open (a division by 0, a large shift) it is
// a value that cannot harm.
#define FARFIELD_UNARY(X)                                              \
    X(negate_f, float, float, -x)                                      \
    X(negate_i, Cell, Cell, 0u - x)                                    \
    X(not_b, Cell, Cell, x ^ 1u)                                       \
    X(not_i, Cell, Cell, ~x)                                           \
    X(radians, float, float, x * 0.017453292519943295f)                \
    X(degrees, float, float, x * 57.29577951308232f)                   \
    X(sin, float, float, std::sin(x))                                  \
    X(cos, float, float, std::cos(x))                                  \
    X(tan, float, float, std::tan(x))                                  \
    X(asin, float, float, std::asin(x))                                \
    X(acos, float, float, std::acos(x))                                \
    X(atan, float, float, std::atan(x))                                \
    X(sinh, float, float, std::sinh(x))                                \
    X(cosh, float, float, std::cosh(x))                                \
    X(tanh, float, float, std::tanh(x))                                \
    X(asinh, float, float, std::asinh(x))                              \
    X(acosh, float, float, std::acosh(x))                              \
    X(atanh, float, float, std::atanh(x))                              \
    X(exp, float, float, std::exp(x))                                  \
    X(log, float, float, std::log(x))                                  \
    X(exp2, float, float, std::exp2(x))                                \
    X(log2, float, float, std::log2(x))                                \
    X(sqrt, float, float, std::sqrt(x))                                \
    X(inversesqrt, float, float, 1.0f / std::sqrt(x))                  \
    X(abs_f, float, float, std::fabs(x))                               \
    X(abs_i, Cell, Cell, x >> 31 ? 0u - x : x)                         \
    X(sign_f, float, float, x > 0.0f ? 1.0f : x < 0.0f ? -1.0f : 0.0f) \
    X(sign_i, std::int32_t, std::int32_t, x > 0 ? 1 : x < 0 ? -1 : 0)  \
    X(floor, float, float, std::floor(x))                              \
    X(trunc, float, float, std::trunc(x))                              \
    X(round, float, float, std::nearbyint(x))                          \
    X(ceil, float, float, std::ceil(x))                                \
    X(fract, float, float, x - std::floor(x))                          \
    X(isnan, Cell, float, std::isnan(x))                               \
    X(isinf, Cell, float, std::isinf(x))                               \
    X(float_to_int, std::int32_t, float, to_integer<std::int32_t>(x))  \
    X(float_to_uint, Cell, float, to_integer<Cell>(x))                 \
    X(float_to_bool, Cell, float, x != 0.0f)                           \
    X(int_to_float, float, std::int32_t, static_cast<float>(x))        \
    X(uint_to_float, float, Cell, static_cast<float>(x))               \
    X(int_to_bool, Cell, Cell, x != 0u)

#define FARFIELD_BINARY(X)                                                    \
    X(add_f, float, float, x + y)                                             \
    X(add_i, Cell, Cell, x + y)                                               \
    X(subtract_f, float, float, x - y)                                        \
    X(subtract_i, Cell, Cell, x - y)                                          \
    X(multiply_f, float, float, x* y)                                         \
    X(multiply_i, Cell, Cell, x* y)                                           \
    X(divide_f, float, float, x / y)                                          \
    X(divide_i, std::int64_t, std::int32_t, y == 0 ? 0 : std::int64_t{x} / y) \
    X(divide_u, Cell, Cell, y == 0u ? 0u : x / y)                             \
    X(mod_f, float, float, x - y * std::floor(x / y))                         \
    X(mod_i, std::int64_t, std::int32_t, y == 0 ? 0 : std::int64_t{x} % y)    \
    X(mod_u, Cell, Cell, y == 0u ? 0u : x % y)                                \
    X(min_f, float, float, y < x ? y : x)                                     \
    X(min_i, std::int32_t, std::int32_t, y < x ? y : x)                       \
    X(min_u, Cell, Cell, y < x ? y : x)                                       \
    X(max_f, float, float, x < y ? y : x)                                     \
    X(max_i, std::int32_t, std::int32_t, x < y ? y : x)                       \
    X(max_u, Cell, Cell, x < y ? y : x)                                       \
    X(pow, float, float, std::pow(x, y))                                      \
    X(atan2, float, float, std::atan2(x, y))                                  \
    X(step, float, float, y < x ? 0.0f : 1.0f)                                \
    X(shift_left, Cell, Cell, x << (y & 31u))                                 \
    X(shift_right_i, std::int32_t, std::int32_t, x >> (y & 31))               \
    X(shift_right_u, Cell, Cell, x >> (y & 31u))                              \
    X(and_i, Cell, Cell, x& y)                                                \
    X(or_i, Cell, Cell, x | y)                                                \
    X(xor_i, Cell, Cell, x ^ y)                                               \
    X(less_f, Cell, float, x < y)                                             \
    X(less_i, Cell, std::int32_t, x < y)                                      \
    X(less_u, Cell, Cell, x < y)                                              \
    X(less_equal_f, Cell, float, x <= y)                                      \
    X(less_equal_i, Cell, std::int32_t, x <= y)                               \
    X(less_equal_u, Cell, Cell, x <= y)                                       \
    X(equal_f, Cell, float, x == y)                                           \
    X(equal_i, Cell, Cell, x == y)                                            \
    X(not_equal_f, Cell, float, x != y)                                       \
    X(not_equal_i, Cell, Cell, x != y)

#define FARFIELD_TERNARY(X)                                                           \
    X(clamp_f, float, float, std::fmin(std::fmax(x, y), z))                           \
    X(clamp_i, std::int32_t, std::int32_t, x < y ? (y < z ? y : z) : (x < z ? x : z)) \
    X(clamp_u, Cell, Cell, x < y ? (y < z ? y : z) : (x < z ? x : z))                 \
    X(mix_f, float, float, x*(1.0f - z) + y * z)                                      \
    X(select, Cell, Cell, z != 0u ? y : x)                                            \
    X(smoothstep, float, float, smooth_step(x, y, z))                                 \
    X(fma, float, float, x* y + z)

enum class Operation : std::uint8_t {
#define FARFIELD_NAME(name, ...) name,
    FARFIELD_UNARY(FARFIELD_NAME) FARFIELD_BINARY(FARFIELD_NAME) FARFIELD_TERNARY(FARFIELD_NAME)
#undef FARFIELD_NAME
    // on whole vectors of n components
    any,
    all,
    dot,
    length,
    normalize,
    cross,
    faceforward,
    reflect,
    refract,
    // on matrices: `rows` and `columns` are those of the result, n the inner dimension
    matrix_product,  ///< vectors are matrices of one row or column
    outer_product,
    transpose,
    determinant,  ///< n x n
    inverse,      ///< n x n
    // moving
    move,     ///< n cells
    gather,   ///< result[i] = (a + offset in b)[selector i of c]; n <= 4
    scatter,  ///< (result + offset in b)[selector i of c] = a[i]; n <= 4
    load,     ///< n cells from a + offset in b
    store,    ///< n cells from a to result + offset in b
    index,    ///< result = offset in b + (a clamped to 0..n - 1) * c
    // control
    jump,           ///< to c
    jump_if_false,  ///< to c when a is false
    jump_if_equal,  ///< to c when a == b, as integers
    repeat,         ///< jump back to c; counted
    call,           ///< to c
    return_,
};

struct Instruction {
    Operation operation{};
    std::uint8_t step_a = 1, step_b = 1, step_c = 1;  ///< 0 repeats a scalar operand for all components
    std::uint8_t rows = 0, columns = 0;
    std::uint16_t n = 1;
    int result = 0, a = 0, b = 0, c = 0;
};

inline constexpr int no_offset = INT32_MIN;  ///< in b of gather, scatter, load, store and index: the offset is 0

struct CustomProgram {
    std::vector<Instruction> instructions;
    std::vector<Cell> constants;  ///< those at addresses -size .. -1
    int cells = 0;                ///< from address 0
    int entry = 0;                ///< of sdf
    int point = 0;                ///< where its argument lies
    int result = 0;
    std::uint64_t repetitions = 0;  ///< the most that one evaluation takes
};

/// Runs the program; `inputs` are the first cells. No instruction can leave the cells of a program that the compiler
/// made, whatever the inputs are, and it ends.
float run(const CustomProgram& program, const float point[3], const Cell* inputs, int input_count);

}  // namespace farfield
