// The outline of what is selected and the grid on the ground, over the picture. A thread finds the lines once a
// hand rests; the latest scene wins. An outline is drawn while the shapes and the camera are those it
// was found for, and not otherwise. The grid stands still in the world: while the camera moves it is drawn with what
// was seen of it last.
#pragma once

#include "app/picture_lines.h"
#include "ui/ui.h"

#include <condition_variable>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

namespace farfield {

class PictureOverlay {
public:
    PictureOverlay();
    ~PictureOverlay();
    PictureOverlay(const PictureOverlay&) = delete;
    PictureOverlay& operator=(const PictureOverlay&) = delete;

    /// `shown`: the scene as it is rendered.
    void draw(Ui& ui, const std::shared_ptr<const Scene>& shown, const PictureView& view);
    /// Whether there are lines that no frame has drawn yet.
    bool news() const;
    /// Whether the thread is about to be asked: draw again soon.
    bool waits() const { return due_ != 0.0 || !current_; }

private:
    struct Request {
        std::shared_ptr<const Scene> scene;
        glm::vec2 low{0.0f}, size{0.0f};
        std::vector<Id> selected;  ///< none: no outline
        bool grid = false;
        std::string key{};  ///< equal where the lines are
    };
    struct Lines {
        std::string key;
        std::vector<Segment> outline;
        GroundGrid grid;
        std::vector<bool> seen;  ///< empty: not looked for
    };

    void work();
    static std::vector<Id> outlined(const Ui& ui, const Scene& scene);
    Lines find(const Request& request);
    void ask(const Ui& ui, const std::shared_ptr<const Scene>& shown, const PictureView& view);
    void draw_outline(Ui& ui) const;
    void draw_grid(const Ui& ui, const Scene& scene, const PictureView& view) const;

    mutable std::mutex mutex_;  ///< guards the next four
    std::condition_variable wake_;
    std::optional<Request> next_;
    std::optional<Lines> found_;
    bool stop_ = false;

    Request asked_;
    bool current_ = false;    ///< `asked_` is what is on screen
    double next_look_ = 0.0;  ///< in ImGui's time
    double due_ = 0.0;        ///< when the thread is to be asked, in ImGui's time; 0: it was
    Lines lines_;
    std::thread thread_;
};

}  // namespace farfield
