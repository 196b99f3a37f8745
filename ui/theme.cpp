#include "ui/theme.h"

#include "ui/fonts.h"

#include <imgui_freetype.h>

#include <array>
#include <filesystem>

namespace farfield {
namespace {

// Latin, Greek, the degree sign and superscripts of units, dashes, arrows and the ellipsis.
constexpr std::array<ImWchar, 15> glyph_ranges = {0x20,   0x17f,  0x2c6,  0x2dd,  0x370,  0x3ff,  0x2010, 0x2026,
                                                  0x2070, 0x208e, 0x2190, 0x2193, 0x2212, 0x2212, 0};

ImFont* load_font(const fonts::Files& files, float size) {
    ImFontAtlas& atlas = *ImGui::GetIO().Fonts;
    for (const char* file : files) {
        std::error_code ignored;
        if (!std::filesystem::is_regular_file(file, ignored)) continue;
        if (ImFont* font = atlas.AddFontFromFileTTF(file, size, nullptr, glyph_ranges.data())) return font;
    }
    ImFontConfig config;
    config.SizePixels = size;
    return atlas.AddFontDefault(&config);
}

ImVec4 gray(int r, int g, int b, float alpha = 1.0f) {
    return {static_cast<float>(r) / 255.0f, static_cast<float>(g) / 255.0f, static_cast<float>(b) / 255.0f, alpha};
}

void set_style(const Theme& theme) {
    ImGuiStyle& style = ImGui::GetStyle();
    style = ImGuiStyle();
    ImGui::StyleColorsDark();
    style.WindowPadding = {10, 8};
    style.FramePadding = {7, 4};
    style.ItemSpacing = {7, 5};
    style.ItemInnerSpacing = {5, 4};
    style.CellPadding = {5, 2};
    style.IndentSpacing = 16;
    style.ScrollbarSize = 11;
    style.GrabMinSize = 9;
    style.WindowRounding = 5;
    style.ChildRounding = 0;
    style.FrameRounding = 4;
    style.PopupRounding = 5;
    style.GrabRounding = 3;
    style.ScrollbarRounding = 6;
    style.TabRounding = 4;
    style.WindowBorderSize = 1;
    style.ChildBorderSize = 0;
    style.PopupBorderSize = 1;
    style.FrameBorderSize = 0;
    style.WindowTitleAlign = {0.0f, 0.5f};
    style.DisabledAlpha = 0.45f;
    style.ScaleAllSizes(theme.scale);

    const ImVec4 accent = ImGui::ColorConvertU32ToFloat4(theme.accent);
    const auto glow = [&](float alpha) { return ImVec4(accent.x, accent.y, accent.z, alpha); };
    ImVec4* c = style.Colors;
    c[ImGuiCol_Text] = ImGui::ColorConvertU32ToFloat4(theme.text);
    c[ImGuiCol_TextDisabled] = ImGui::ColorConvertU32ToFloat4(theme.dim);
    c[ImGuiCol_WindowBg] = gray(20, 22, 26);
    c[ImGuiCol_ChildBg] = gray(28, 31, 36);
    c[ImGuiCol_PopupBg] = gray(34, 37, 43);
    c[ImGuiCol_Border] = gray(62, 67, 76);
    c[ImGuiCol_BorderShadow] = gray(0, 0, 0, 0.0f);
    c[ImGuiCol_FrameBg] = gray(44, 48, 56);
    c[ImGuiCol_FrameBgHovered] = gray(54, 59, 69);
    c[ImGuiCol_FrameBgActive] = gray(62, 68, 80);
    c[ImGuiCol_TitleBg] = c[ImGuiCol_TitleBgActive] = c[ImGuiCol_TitleBgCollapsed] = gray(37, 41, 48);
    c[ImGuiCol_MenuBarBg] = gray(28, 31, 36);
    c[ImGuiCol_ScrollbarBg] = gray(0, 0, 0, 0.0f);
    c[ImGuiCol_ScrollbarGrab] = gray(66, 71, 81);
    c[ImGuiCol_ScrollbarGrabHovered] = gray(82, 88, 100);
    c[ImGuiCol_ScrollbarGrabActive] = gray(96, 102, 116);
    c[ImGuiCol_CheckMark] = accent;
    c[ImGuiCol_SliderGrab] = glow(0.75f);
    c[ImGuiCol_SliderGrabActive] = accent;
    c[ImGuiCol_Button] = gray(52, 57, 66);
    c[ImGuiCol_ButtonHovered] = gray(66, 72, 83);
    c[ImGuiCol_ButtonActive] = gray(78, 85, 98);
    c[ImGuiCol_Header] = glow(0.20f);
    c[ImGuiCol_HeaderHovered] = gray(52, 57, 66);
    c[ImGuiCol_HeaderActive] = glow(0.30f);
    c[ImGuiCol_Separator] = gray(50, 54, 62);
    c[ImGuiCol_SeparatorHovered] = glow(0.6f);
    c[ImGuiCol_SeparatorActive] = accent;
    c[ImGuiCol_ResizeGrip] = gray(66, 71, 81);
    c[ImGuiCol_ResizeGripHovered] = glow(0.6f);
    c[ImGuiCol_ResizeGripActive] = accent;
    c[ImGuiCol_TableHeaderBg] = gray(37, 41, 48);
    c[ImGuiCol_TableBorderLight] = gray(44, 48, 56);
    c[ImGuiCol_TableBorderStrong] = gray(50, 54, 62);
    c[ImGuiCol_TextSelectedBg] = glow(0.35f);
    c[ImGuiCol_DragDropTarget] = accent;
    c[ImGuiCol_NavHighlight] = glow(0.8f);
    c[ImGuiCol_ModalWindowDimBg] = gray(8, 9, 11, 0.6f);
}

}  // namespace

ImU32 Theme::role(Role role) const {
    switch (role) {
        case Role::primitive:
            return IM_COL32(110, 170, 225, 255);
        case Role::combine:
            return IM_COL32(236, 178, 96, 255);
        case Role::domain:
        case Role::repeat:
            return IM_COL32(130, 196, 128, 255);
        case Role::distance:
            return IM_COL32(190, 145, 220, 255);
        case Role::instance:
            return IM_COL32(110, 200, 200, 255);
    }
    return text;
}

Theme make_theme(float pixel_scale) {
    Theme theme;
    theme.scale = pixel_scale;
    ImFontAtlas& atlas = *ImGui::GetIO().Fonts;
    atlas.Clear();
    atlas.FontBuilderIO = ImGuiFreeType::GetBuilderForFreeType();
    atlas.FontBuilderFlags = ImGuiFreeTypeBuilderFlags_LightHinting;
    theme.regular = load_font(fonts::regular, theme.px(15.0f));
    theme.bold = load_font(fonts::bold, theme.px(15.0f));
    theme.small_font = load_font(fonts::regular, theme.px(13.0f));
    theme.mono = load_font(fonts::mono, theme.px(16.0f));
    set_style(theme);
    return theme;
}

}  // namespace farfield
