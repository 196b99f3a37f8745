#include "renderer/sobol.h"

#include <array>
#include <bit>
#include <cstdint>

namespace farfield {
namespace {

constexpr std::size_t dimensions = 2 * sobol_pairs, bits = 32, most_degree = 7;

/// A primitive polynomial over GF(2): x^degree + ... + 1 with the coefficients between as bits, and the first direction
/// numbers.
struct Polynomial {
    unsigned degree, coefficients;
    std::array<unsigned, most_degree> first;
};

/// Of dimension 1 and those after; dimension 0 is van der Corput's sequence. Joe and Kuo's file new-joe-kuo-6.21201.
constexpr std::array<Polynomial, dimensions - 1> polynomials = {{
    {1, 0, {1}},
    {2, 1, {1, 3}},
    {3, 1, {1, 3, 1}},
    {3, 2, {1, 1, 1}},
    {4, 1, {1, 1, 3, 3}},
    {4, 4, {1, 3, 5, 13}},
    {5, 2, {1, 1, 5, 5, 17}},
    {5, 4, {1, 1, 5, 5, 5}},
    {5, 7, {1, 1, 7, 11, 19}},
    {5, 11, {1, 1, 5, 1, 1}},
    {5, 13, {1, 1, 1, 3, 11}},
    {5, 14, {1, 3, 5, 5, 31}},
    {6, 1, {1, 3, 3, 9, 7, 49}},
    {6, 13, {1, 1, 1, 15, 21, 21}},
    {6, 16, {1, 3, 1, 13, 27, 49}},
    {6, 19, {1, 1, 1, 15, 7, 5}},
    {6, 22, {1, 3, 1, 15, 13, 25}},
    {6, 25, {1, 1, 5, 5, 19, 61}},
    {7, 1, {1, 3, 7, 11, 23, 15, 103}},
}};

using Directions = std::array<std::array<unsigned, bits>, dimensions>;

constexpr Directions make_directions() {
    Directions v{};
    for (std::size_t k = 0; k < bits; ++k) v[0][k] = 1u << (bits - 1 - k);
    for (std::size_t d = 1; d < dimensions; ++d) {
        const Polynomial& p = polynomials[d - 1];
        for (std::size_t k = 0; k < bits; ++k) {
            if (k < p.degree) {
                v[d][k] = p.first[k] << (bits - 1 - k);
                continue;
            }
            v[d][k] = v[d][k - p.degree] ^ (v[d][k - p.degree] >> p.degree);
            for (std::size_t j = 1; j < p.degree; ++j)
                if ((p.coefficients >> (p.degree - 1 - j)) & 1u) v[d][k] ^= v[d][k - j];
        }
    }
    return v;
}

constexpr Directions directions = make_directions();

}  // namespace

glm::uvec2 sobol(unsigned index, int pair) {
    glm::uvec2 point(0u);
    const std::size_t d = 2 * static_cast<std::size_t>(pair);
    for (; index != 0; index &= index - 1) {
        const auto k = static_cast<std::size_t>(std::countr_zero(index));
        point ^= glm::uvec2(directions[d][k], directions[d + 1][k]);
    }
    return point;
}

unsigned scrambled(unsigned coordinate, unsigned flips) {
    unsigned result = coordinate;
    for (unsigned level = 0; level < 5; ++level) {
        const unsigned place = (1u << level) + static_cast<unsigned>(std::uint64_t{coordinate} >> (bits - level));
        result ^= ((flips >> place) & 1u) << (bits - 1 - level);
    }
    return result;
}

}  // namespace farfield
