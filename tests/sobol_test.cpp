#include "renderer/sobol.h"

#include <gtest/gtest.h>

#include <set>

namespace farfield {
namespace {

/// Which of 2^digits parts of 0..1 a coordinate lies in; one digit at least.
unsigned part(unsigned coordinate, unsigned digits) { return coordinate >> (32 - digits); }

TEST(Sobol, BeginsAsPublished) {
    // In units of 1/8: dimensions 0 to 3 of points 1 to 4.
    const unsigned expected[][4] = {{4, 4, 4, 4}, {2, 6, 6, 6}, {6, 2, 2, 2}, {1, 5, 3, 1}};
    for (unsigned i = 0; i < 4; ++i)
        for (int pair = 0; pair < 2; ++pair)
            for (int k = 0; k < 2; ++k)
                EXPECT_EQ(part(sobol(i + 1, pair)[k], 3), expected[i][2 * pair + k]) << i << " " << pair << " " << k;
}

TEST(Sobol, EachDimensionIsSpreadEvenly) {
    for (int pair = 0; pair < sobol_pairs; ++pair)
        for (int k = 0; k < 2; ++k)
            for (const unsigned first : {0u, 256u, 5u << 24}) {
                std::set<unsigned> parts;
                for (unsigned i = 0; i < 256; ++i) parts.insert(part(sobol(first + i, pair)[k], 8));
                EXPECT_EQ(parts.size(), 256u) << pair << " " << k << " " << first;
            }
}

TEST(Sobol, DirectionsOfAnyPlaceInThePixelAreSpreadEvenly) {
    // Of 4,096 samples with a new place for each four, the quarter of them in each quadrant of the pixel.
    int count[4][16][16] = {};
    for (unsigned i = 0; i < 4096; ++i) {
        const glm::uvec2 place = sobol(i / 4 * 4, sobol_pair::camera), way = sobol(i, sobol_pair::of_bounce(0));
        ++count[2 * part(place.y, 1) + part(place.x, 1)][part(way.y, 4)][part(way.x, 4)];
    }
    for (const auto& quadrant : count)
        for (const auto& row : quadrant)
            for (const int n : row) EXPECT_EQ(n, 4);
}

TEST(Sobol, NoTwoBouncesShareDimensions) {
    std::set<int> pairs = {sobol_pair::camera};
    for (int bounce = 0; bounce < 9; ++bounce) EXPECT_TRUE(pairs.insert(sobol_pair::of_bounce(bounce)).second);
    EXPECT_LT(*pairs.rbegin(), sobol_pairs);
}

TEST(Sobol, ScramblingKeepsPartsApart) {
    for (const unsigned flips : {0u, 2u, 3219546242u, 0xffffffffu})
        for (unsigned digits = 1; digits <= 8; ++digits) {
            std::set<unsigned> parts;
            for (unsigned i = 0; i < 1u << digits; ++i)
                parts.insert(part(scrambled(i << (32 - digits), flips), digits));
            EXPECT_EQ(parts.size(), 1u << digits) << flips << " " << digits;
        }
    EXPECT_EQ(scrambled(0x12345678u, 0u), 0x12345678u);
    EXPECT_EQ(scrambled(0u, 2u), 0x80000000u);
    EXPECT_EQ(scrambled(0x80000000u, 1u << 3), 0xc0000000u);  // bit 3: the second digit where the first is 1
    EXPECT_EQ(scrambled(0u, 1u << 3), 0u);
}

}  // namespace
}  // namespace farfield
