#include "ui/glsl_text.h"

#include "ui/glsl_tokens.h"

#include <vector>

namespace farfield {
namespace {

ImU32 color_of(const Ui& ui, GlslToken token) {
    switch (token) {
        case GlslToken::keyword:
            return IM_COL32(188, 154, 226, 255);
        case GlslToken::type:
            return IM_COL32(126, 172, 232, 255);
        case GlslToken::number:
            return IM_COL32(152, 204, 156, 255);
        case GlslToken::function:
            return IM_COL32(228, 212, 160, 255);
        case GlslToken::comment:
            return IM_COL32(118, 127, 140, 255);
        case GlslToken::plain:
            break;
    }
    return ui.theme.text;
}

}  // namespace

std::size_t cells_of(std::string_view text) {
    std::size_t cells = 0;
    for (const char c : text)
        if ((static_cast<unsigned char>(c) & 0xc0) != 0x80) cells += c == '\t' ? 4 : 1;
    return cells;
}

void draw_glsl(const Ui& ui, ImDrawList& draw, std::string_view line, ImVec2 at, float cell) {
    const std::vector<GlslRun> runs = glsl_runs(line);
    for (std::size_t i = 0; i < runs.size(); ++i) {
        const std::size_t end = i + 1 < runs.size() ? runs[i + 1].start : line.size();
        const float x = at.x + cell * static_cast<float>(cells_of(line.substr(0, runs[i].start)));
        draw.AddText({x, at.y}, color_of(ui, runs[i].token), line.data() + runs[i].start, line.data() + end);
    }
}

}  // namespace farfield
