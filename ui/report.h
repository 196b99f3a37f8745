// What a test that drives the window by mouse and keyboard needs to know: where each named control is, and what the
// program thinks its state is. Off unless a file is named, and then nothing is stored.
#pragma once

#include "renderer/statistics.h"

#include <imgui.h>

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace farfield {

struct ReportState {
    Statistics statistics;
    std::uint64_t revision = 0;    ///< of the document
    std::uint64_t pictures = 0;    ///< shown so far
    std::string view, beside;      ///< what the last one shows, and on the right side of a split
    double ui_milliseconds = 0.0;  ///< as Ui::frame_milliseconds
    bool saved = true;
    std::string file;    ///< of the document, empty before the first save
    std::string error;   ///< what the error bar shows
    std::string notice;  ///< what the status line says of files
    std::string selection;
    std::vector<std::string> selected;  ///< all nodes, the primary one last
    std::size_t step = 0;               ///< of the history
    bool code = false;                  ///< the code panel is open
    std::size_t code_lines = 0;
    std::vector<std::size_t> selected_lines, inside_lines;  ///< of the code, from 1: the selected node's, and in it
};

class Report {
public:
    struct Rectangle {
        int x, y, width, height;  ///< window pixels
    };
    /// Empty path: off.
    explicit Report(std::filesystem::path file = {}) : file_(std::move(file)) {}

    bool on() const { return !file_.empty(); }
    void begin_frame() { controls_.clear(); }
    /// Those of the last frame, by name.
    const std::map<std::string, Rectangle>& controls() const { return controls_; }
    /// Records the rectangle of the last ImGui item as "PANEL/NAME", if its middle is not scrolled out of sight.
    void item(std::string_view panel, std::string_view name);
    void rectangle(std::string_view panel, std::string_view name, ImVec2 low, ImVec2 high);
    /// Writes controls (window pixels: x, y, width, height) and state as JSON when they changed, ten times a second at
    /// most. Atomic, so that a reader sees a whole file.
    void write(const ReportState& state, double now);

private:
    std::filesystem::path file_;
    std::map<std::string, Rectangle> controls_;
    std::string written_;
    double last_write_ = -1.0;
};

}  // namespace farfield
