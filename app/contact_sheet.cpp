#include "app/contact_sheet.h"

#include "app/commands.h"
#include "app/kind_samples.h"
#include "ui/fonts.h"
#include "app/progress.h"
#include "renderer/renderer.h"
#include "sdf/suggestion.h"

#include <OpenImageIO/imagebuf.h>
#include <OpenImageIO/imagebufalgo.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>

namespace farfield {
namespace {

using Kinds = std::vector<const KindInfo*>;

struct Group {
    Role role;
    Kinds kinds;
};

const char* heading(Role role) {
    switch (role) {
        case Role::primitive:
            return "Primitives";
        case Role::combine:
            return "Combinations";
        case Role::domain:
            return "Modifiers of space";
        case Role::repeat:
            return "Repetitions";
        case Role::distance:
            return "Modifiers of distance";
        case Role::instance:
            return "Instances";
    }
    return "";
}

/// The kinds asked for, by role, each in the table's order.
std::vector<Group> grouped(const std::vector<std::string>& only) {
    std::vector<std::string_view> known;
    for (const KindInfo& kind : node_kinds()) known.push_back(kind.key);
    for (const std::string& key : only)
        if (!find_kind(key))
            throw std::invalid_argument(fmt::format("--only: \"{}\" given, {}", key, expected_one_of(known, key)));

    std::vector<Group> groups;
    for (const KindInfo& kind : node_kinds()) {
        if (!only.empty() && std::find(only.begin(), only.end(), kind.key) == only.end()) continue;
        auto group = std::find_if(groups.begin(), groups.end(), [&](const Group& g) { return g.role == kind.role; });
        if (group == groups.end()) group = groups.insert(groups.end(), {kind.role, {}});
        group->kinds.push_back(&kind);
    }
    return groups;
}

/// Display-ready pixels with text on them. The fonts are those of the editor; see app/packages.
class Sheet {
public:
    explicit Sheet(glm::ivec2 size)
        : size_(size),
          rgb_(static_cast<std::size_t>(size.x) * size.y * 3, 24),
          buffer_(OIIO::ImageSpec(size.x, size.y, 3, OIIO::TypeDesc::UINT8), rgb_.data()) {}

    void place(const std::vector<unsigned char>& rgb, glm::ivec2 size, glm::ivec2 at) {
        for (int y = 0; y < size.y; ++y)
            std::copy_n(&rgb[static_cast<std::size_t>(y) * size.x * 3], size.x * 3,
                        &rgb_[(static_cast<std::size_t>(at.y + y) * size_.x + at.x) * 3]);
    }

    enum class Align { left, centre };
    /// In a field that begins at `at`, the text's baseline; smaller than `height` where it is wider than that.
    void write(const char* text, glm::ivec2 at, int width, int height, const fonts::Files& font, Align align) {
        const char* file = std::filesystem::exists(font[0]) ? font[0] : font[1];
        constexpr std::array<float, 3> colour{0.87f, 0.89f, 0.91f};
        const OIIO::ROI size = OIIO::ImageBufAlgo::text_size(text, height, file);
        if (size.defined() && size.width() > width) height = std::max(1, height * width / size.width());
        const bool centred = align == Align::centre;
        if (!OIIO::ImageBufAlgo::render_text(
                buffer_, centred ? at.x + width / 2 : at.x, at.y, text, height, file, colour,
                centred ? OIIO::ImageBufAlgo::TextAlignX::Center : OIIO::ImageBufAlgo::TextAlignX::Left))
            throw ImageError(fmt::format("no text can be drawn: {}", buffer_.geterror()));
    }

    void save(const std::filesystem::path& file) const { write_display(file, size_, rgb_); }

private:
    glm::ivec2 size_;
    std::vector<unsigned char> rgb_;
    OIIO::ImageBuf buffer_;  ///< a view of rgb_
};

/// Where things go, in pixels. Text and gaps grow with the tiles.
class Layout {
public:
    struct Heading {
        const char* text;
        glm::ivec2 at;
        int width;
    };
    struct Tile {
        const KindInfo* kind;
        glm::ivec2 at;
    };

    /// A group begins a row, or continues one where all of it fits.
    Layout(const ContactSheetOptions& options, const std::vector<Group>& groups)
        : tile(options.tile), unit_(std::clamp(static_cast<float>(tile.x) / 200.0f, 0.2f, 4.0f)) {
        int column = 0, widest = 0;
        bool one_row = true;  // so far
        for (const Group& group : groups) {
            const int count = static_cast<int>(group.kinds.size());
            const bool fits = column + count <= options.columns;
            if (column > 0 && !(one_row && fits)) column = 0;
            if (column == 0) top_.push_back(after_last_row(true));
            one_row = fits;
            headings.push_back({heading(group.role), at(column, -px(12)),
                                std::min(count, options.columns) * (tile.x + px(10)) - px(20)});
            for (const KindInfo* kind : group.kinds) {
                if (column == options.columns) {
                    column = 0;
                    top_.push_back(after_last_row(false));
                }
                tiles.push_back({kind, at(column, 0)});
                widest = std::max(widest, ++column);
            }
        }
        size = {at(widest, 0).x - px(10) + px(20), after_last_row(false) + px(10)};
    }
    int px(float at_200) const { return static_cast<int>(at_200 * unit_ + 0.5f); }

    glm::ivec2 tile;
    glm::ivec2 size{0};
    std::vector<Heading> headings;  ///< at the baseline
    std::vector<Tile> tiles;

private:
    int after_last_row(bool heading) const {
        return (top_.empty() ? px(6) : top_.back() + tile.y + px(34)) + (heading ? px(44) : 0);
    }
    glm::ivec2 at(int column, int below) const { return {px(20) + column * (tile.x + px(10)), top_.back() + below}; }
    float unit_;
    std::vector<int> top_;  ///< of the tiles of each row
};

}  // namespace

int run_contact_sheet(const ContactSheetOptions& options) {
    check_output(options.output, {".png", ".jpg"});
    const std::vector<Group> groups = grouped(options.only);
    const Layout layout(options, groups);
    Sheet sheet(layout.size);

    const std::unique_ptr<Context> context = make_headless_context(options.context);
    context->make_current();
    Renderer renderer;
    FrameOptions frame;
    frame.size = options.tile;
    const float aspect = static_cast<float>(options.tile.x) / static_cast<float>(options.tile.y);
    Progress progress("rendering", static_cast<int>(layout.tiles.size()) * options.frames);
    for (const Layout::Heading& heading : layout.headings)
        sheet.write(heading.text, heading.at, heading.width, layout.px(20), fonts::bold, Sheet::Align::left);
    for (const Layout::Tile& tile : layout.tiles) {
        renderer.update(sample_scene(*tile.kind, aspect), frame);
        if (!render_frames(renderer, options.frames, progress)) return 1;
        sheet.place(renderer.display_pixels(), options.tile, tile.at);
        sheet.write(tile.kind->label, tile.at + glm::ivec2(0, options.tile.y + layout.px(20)), options.tile.x,
                    layout.px(15), fonts::regular, Sheet::Align::centre);
    }
    sheet.save(options.output);
    return 0;
}

}  // namespace farfield
