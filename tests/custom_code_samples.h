// Custom code for tests, and what becomes of it when a careless hand or a broken file changes it.
#pragma once

#include <cctype>
#include <iterator>
#include <random>
#include <string>

namespace farfield {

/// Texts with everything in them, to be mutated.
inline const char* const custom_code_samples[] = {
    "uniform float radius = 0.5; // [0, 2] m Radius\nuniform int n = 3; // [1, 6]\nstruct S { vec3 c; float r[2]; "
    "};\nconst float k[3] = float[3](1.0, 2.0, 3.0);\n"
    "float f(inout S s, vec3 p) { s.r[1] += 1.0; return length(p - s.c) - s.r[0] * k[2]; }\n"
    "float sdf(vec3 p) {\n    float d = 1e6;\n    for (int i = 0; i < n; ++i) {\n        S s = S(vec3(float(i)), "
    "float[2](radius, 1.0));\n        d = min(d, f(s, p.zyx * 2.0));\n"
    "        if (d < 0.0 && i > 1) break;\n        p[i % 3] *= 0.5;\n    }\n    switch (n) { case 1: d += 1.0; break; "
    "default: d -= 0.5; }\n    return d > 0.0 ? d : smooth_union(d, box(p, vec3(0.3)), 0.1);\n}\n",
    "mat3 turn(float a) { return mat3(cos(a), 0, -sin(a), 0, 1, 0, sin(a), 0, cos(a)); }\nfloat sdf(vec3 p) { mat3 m = "
    "turn(p.y) * 2.0; ivec3 c = ivec3(floor(p)); uvec2 h = uvec2(c.xy) * 7u ^ 3u;\n"
    "    vec4 v = vec4(p * m, float(h.x % 16u)); v.xz = v.zx - 1.0; v.w = fract(sin(v.w) * 43758.5); return "
    "length(v.xyz) / 3.0 - float(c.x << 2 & 5) + mod(v.w, 0.3); }\n"};

/// One of the samples with a word or two replaced, inserted, removed or repeated. Equal seeds give equal texts.
inline std::string mutated_code(unsigned seed) {
    static const char* const words[] = {"0",    "-1",     "2147483647", "0x80000000", "1e39",    "(",
                                        ")",    "{",      "}",          "[",          "]",       ";",
                                        ",",    "for",    "if",         "else",       "float",   "int",
                                        "uint", "vec3",   "mat4",       "struct",     "const",   "uniform",
                                        "out",  "return", "break",      "continue",   "case 1:", "default:",
                                        "p",    "d",      "i",          "n",          "sdf",     "=",
                                        "+=",   "<",      "%",          "/",          "<<",      "++",
                                        "?",    ":",      ".",          "&&",         "^^",      "!",
                                        "~",    "[i]",    ".zyx",       "p.xy",       "while",   "#",
                                        "\\",   "//",     "/*",         "\n",         "s",       "float[2](1.0, 2.0)"};
    std::mt19937 random(seed);
    std::string text = custom_code_samples[seed % 2];
    for (unsigned i = 1 + random() % 2; i > 0; --i) {
        const auto is_word = [](unsigned char c) { return std::isalnum(c) || c == '_'; };
        std::size_t first = random() % text.size(), last = first + 1;
        if (is_word(text[first])) {
            while (first > 0 && is_word(text[first - 1])) --first;
            while (last < text.size() && is_word(text[last])) ++last;
        }
        const std::string word = words[random() % std::size(words)];
        const std::size_t other = random() % text.size();
        switch (random() % 5) {
            case 0:
                text.replace(first, last - first, word);
                break;
            case 1:
                text.insert(first, " " + word + " ");
                break;
            case 2:
                text.erase(first, last - first);
                break;
            case 3:
                text.insert(first, text.substr(other, random() % 60));
                break;
            default:
                text[first] = static_cast<char>(text[first] ^ (1 << random() % 8));
                break;
        }
    }
    return text;
}

}  // namespace farfield
