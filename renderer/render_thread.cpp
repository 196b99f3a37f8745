#include "renderer/render_thread.h"

#include "renderer/picture_file.h"
#include "renderer/renderer.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <condition_variable>
#include <exception>
#include <future>
#include <mutex>
#include <optional>
#include <thread>
#include <vector>

namespace farfield {
namespace {

using Clock = std::chrono::steady_clock;

/// A hand that has not moved anything for so long rests: time to make programs.
constexpr auto rest = std::chrono::milliseconds(250);
/// An edit that comes meanwhile waits for the program that is being made. So those that nobody needs yet wait for so
/// many times what the last one took: of 128 nodes one that is duplicated soon after it was selected shows after 0.42 s
/// instead of 0.72 s.
constexpr double patience = 2.5;
/// What a picture may take while a hand moves something, and the first one after an edit, which often had to wait for a
/// program.
constexpr double interactive_milliseconds = 50.0, first_milliseconds = 40.0;
/// What one step may take, so that an edit is seen soon, and a frame of the user interface as well.
constexpr double step_milliseconds = 10.0;
/// Rays of a step at least: with fewer the dispatches take longer than the rays (8 parts: 3 ms).
constexpr std::size_t least_batch = 1024;
/// So long at most a step waits until the user interface has drawn a frame.
constexpr auto longest_draw = std::chrono::milliseconds(50);
/// A node whose parameters are in more programs than these, as the root's are, gets them when it is moved.
constexpr int most_prepared = 8;
/// Programs of a scene are made for so long although there is a newer one.
constexpr auto longest_compile = std::chrono::seconds(2);
/// A picture of an unfinished frame is shown after so long, and no sooner than three times what showing takes.
constexpr auto longest_wait = std::chrono::milliseconds(150);
/// Scenes with more nodes get no program with every number live: its compilation takes seconds on llvmpipe (27 nodes
/// 0.8 s, 43 nodes 1.6 s). They rely on the program with the selected node live.
constexpr std::uint64_t largest_live_scene = 32;

struct Slot {
    gl::Texture texture, other;
    GLsync fence = nullptr;
    RenderedPicture picture;
};

}  // namespace

struct RenderThread::State {
    std::unique_ptr<Context> context;

    std::mutex mutex;  ///< guards everything down to `held`
    std::condition_variable wake;
    std::optional<RenderRequest> next;
    std::shared_ptr<const Scene> asked_for;
    Clock::time_point edit_time;  ///< when the scene of the latest request was first asked for
    double edit_milliseconds = 0.0;
    bool stop = false;
    bool drawing = false;       ///< the caller draws a frame
    unsigned drawn = 0;         ///< frames of the caller
    std::array<Slot, 3> slots;  ///< one held by the caller, one ready, one to draw into
    int ready = -1;
    int held = -1;
    std::string error;  ///< of the latest request
    int compiled = 0, to_compile = 0;
    Statistics statistics;
    std::vector<PictureWish> wishes;
    std::vector<WrittenPicture> written;

    std::thread thread;
    std::vector<std::future<void>> writing;  ///< of the thread; each is waited for at the end

    // The rest belongs to the thread.
    std::optional<Renderer> renderer;
    RenderRequest current;
    FrameOptions options;
    Clock::time_point request_time, shown_time;
    Clock::duration show_time{};                   ///< what the last picture took to filter and draw
    std::optional<Clock::time_point> unseen_edit;  ///< its scene has not been shown yet
    std::uint64_t serial = 0;
    double milliseconds_per_pixel_sample = 0.0;  ///< measured on the last frame; 0: not yet
    bool unshown = false;                        ///< another view, other settings or a frame worth showing
    bool dropped = false;                        ///< the last picture was outdated before it was filtered
    bool abandoned = false;                      ///< so was the last scene before its programs were there
    int shown_samples = 0;
    std::optional<double> noise;  ///< of the picture as it is asked for
    int noise_samples = 0;        ///< when it was estimated last; 0: not yet
    bool preview = false;         ///< the first picture after an edit, quick and small
    bool prepared = false;        ///< every program that the next edit may need is there
    bool gave_up = false;         ///< background compilation failed for this scene: do not try again

    void run();
    bool render();
    bool wait_to_try_again();
    bool wait_for_work();
    void take_request();
    void update(Tier tier, Id tuned);
    bool make_programs(Tier tier, Id tuned);
    bool compile_in_background();
    void compile_one(Tier tier, Id tuned);
    void work();
    void wait_while_drawing();
    bool outdated();
    void show();
    void write_pictures();
    bool grants(const PictureWish& wish) const;
    bool can_write();
    void estimate_noise();
    bool finished() const {
        const bool all = current.max_frames > 0 && renderer->statistics().frames >= current.max_frames;
        const double percent = current.scene->settings.noise;
        const bool good = percent > 0.0 && noise && 100.0 * *noise <= percent;
        return (all || good) && !quick();
    }
    bool has_work() const { return current.scene && current.size.x > 0 && current.size.y > 0 && renderer->ready(); }
    bool quick() const { return current.interacting || preview; }
    glm::ivec2 quick_size() const;
};

RenderThread::RenderThread(std::unique_ptr<Context> context) : state_(std::make_unique<State>()) {
    state_->context = std::move(context);
    state_->thread = std::thread([state = state_.get()] { state->run(); });
}

RenderThread::~RenderThread() {
    {
        const std::lock_guard lock(state_->mutex);
        state_->stop = true;
    }
    state_->wake.notify_one();
    state_->thread.join();
}

void RenderThread::submit(RenderRequest request) {
    {
        const std::lock_guard lock(state_->mutex);
        if (request.scene != state_->asked_for) state_->edit_time = Clock::now();
        state_->asked_for = request.scene;
        state_->next = std::move(request);
    }
    state_->wake.notify_one();
}

RenderedPicture RenderThread::acquire() {
    const std::lock_guard lock(state_->mutex);
    if (state_->ready >= 0) {
        state_->held = std::exchange(state_->ready, -1);
        Slot& slot = state_->slots[static_cast<std::size_t>(state_->held)];
        glWaitSync(slot.fence, 0, GL_TIMEOUT_IGNORED);
        glDeleteSync(std::exchange(slot.fence, nullptr));
    }
    RenderedPicture picture;
    if (state_->held >= 0) picture = state_->slots[static_cast<std::size_t>(state_->held)].picture;
    picture.statistics = state_->statistics;
    picture.statistics.edit_milliseconds = state_->edit_milliseconds;
    picture.error = state_->error;
    picture.compiled = state_->compiled;
    picture.to_compile = state_->to_compile;
    return picture;
}

void RenderThread::give_way(bool drawing) {
    {
        const std::lock_guard lock(state_->mutex);
        state_->drawing = drawing;
        state_->drawn += !drawing;
    }
    if (!drawing) state_->wake.notify_one();
}

void RenderThread::write(PictureWish wish) {
    {
        const std::lock_guard lock(state_->mutex);
        state_->wishes.push_back(std::move(wish));
    }
    state_->wake.notify_one();
}

std::optional<WrittenPicture> RenderThread::written() {
    const std::lock_guard lock(state_->mutex);
    if (state_->written.empty()) return std::nullopt;
    WrittenPicture first = std::move(state_->written.front());
    state_->written.erase(state_->written.begin());
    return first;
}

void RenderThread::State::run() {
    bool working = false;
    try {
        context->make_current();
        working = true;
    } catch (const std::exception& failure) {
        const std::lock_guard lock(mutex);
        error = std::string("nothing can be rendered: ") + failure.what();
    }
    while (working && !render()) working = wait_to_try_again();
    // Everything of OpenGL goes while the context is current.
    renderer.reset();
    for (Slot& slot : slots) {
        if (slot.fence) glDeleteSync(slot.fence);
        slot = {};
    }
    context->release();
}

/// Until the end, or a failure of the driver: then false, and the last picture is all there is.
bool RenderThread::State::render() {
    try {
        renderer.emplace();
        while (wait_for_work()) work();
        return true;
    } catch (const std::exception& failure) {
        const std::lock_guard lock(mutex);
        error = std::string("rendering has failed, the next change tries again: ") + failure.what();
    }
    renderer.reset();
    current = {};
    options = {};
    preview = unshown = false;
    return false;
}

/// What has failed would fail again: another request is waited for. False when the thread shall end.
bool RenderThread::State::wait_to_try_again() {
    std::unique_lock lock(mutex);
    wake.wait(lock, [&] { return stop || next; });
    return !stop;
}

/// Takes the next request if there is one; sleeps when there is nothing to do. False when the thread shall end.
bool RenderThread::State::wait_for_work() {
    std::unique_lock lock(mutex);
    const bool idle = !has_work() || (finished() && !unshown);
    if (idle) {
        const Clock::time_point start = Clock::now();
        wake.wait(lock, [&] { return stop || next || can_write(); });
        renderer->paused(Clock::now() - start);
    }
    if (stop) return false;
    // A quick picture is finished and shown before a newer request counts: a hand that moves all the time must see
    // something.
    const bool busy = has_work() && quick() && unshown && !gave_up;
    if (!next || busy) return true;
    if (next->scene != current.scene) unseen_edit = edit_time;
    current = std::move(*next);
    next.reset();
    lock.unlock();
    take_request();
    return true;
}

/// So small that a picture with one sample keeps to its time.
glm::ivec2 RenderThread::State::quick_size() const {
    if (milliseconds_per_pixel_sample <= 0.0) return glm::max(current.size / 8, glm::ivec2(1));
    const double pixels = (current.interacting ? interactive_milliseconds : first_milliseconds) /
                          (2.0 * milliseconds_per_pixel_sample);  // 2: one sample, and the camera's
    const double full = static_cast<double>(current.size.x) * current.size.y;
    int divisor = 1;
    while (divisor < 8 && full / (divisor * divisor) > pixels) divisor *= 2;
    return glm::max(current.size / divisor, glm::ivec2(1));
}

void RenderThread::State::take_request() {
    gave_up = prepared = false;
    if (!current.scene || current.size.x <= 0 || current.size.y <= 0) return;
    const Scene& scene = *current.scene;
    preview = !current.interacting && !renderer->keeps_samples(scene, options) && quick_size() != current.size;
    // Whatever is there already, the fastest first; a structure not met before has to be compiled. So has the program
    // for a hand that was quicker than the rest it should have been made in: it serves all further moves.
    if (!renderer->needs_compile(scene, Tier::specialised))
        update(Tier::specialised, 0);
    else if (current.tuned && !renderer->needs_compile(scene, Tier::specialised, current.tuned))
        update(Tier::specialised, current.tuned);
    else if (!renderer->needs_compile(scene, Tier::live))
        update(Tier::live, 0);
    else if (const Id tuned = current.interacting ? current.tuned : 0; make_programs(Tier::specialised, tuned))
        update(Tier::specialised, tuned);
    request_time = Clock::now();  // to prepare for the next edit before this one shows would be too early
}

/// One kernel after the other; false when a newer scene came meanwhile. Not twice in a row, unless it takes long:
/// something must be seen.
bool RenderThread::State::make_programs(Tier tier, Id tuned) {
    const Clock::time_point start = Clock::now();
    bool outdated = false;
    try {
        const int all = renderer->missing_programs(*current.scene, tier, tuned);
        for (int left = all; left > 0 && !outdated;) {
            left = renderer->compile_one(*current.scene, tier, tuned);
            const std::lock_guard lock(mutex);
            to_compile = all, compiled = all - left;
            const bool newer = next && next->scene != current.scene;
            outdated = left > 0 && (stop || (newer && (!abandoned || Clock::now() - start > longest_compile)));
        }
    } catch (const std::exception&) {
        // update() will meet it as well, and tell.
    }
    const std::lock_guard lock(mutex);
    compiled = to_compile = 0;
    abandoned = outdated;
    if (outdated) unshown = false;
    return !outdated;
}

void RenderThread::State::update(Tier tier, Id tuned) {
    const glm::ivec2 last_size = options.size;
    options.size = quick() ? quick_size() : current.size;
    options.view = current.view;
    options.other = current.other;
    options.samples = quick() ? 1 : 0;
    options.measure_bounces = !quick();
    options.reprojection = true;
    options.batch = 1 << 12;
    if (milliseconds_per_pixel_sample > 0.0)
        options.batch = std::max(static_cast<std::size_t>(step_milliseconds / milliseconds_per_pixel_sample) / 64 * 64,
                                 least_batch);
    options.tier = tier;
    options.tuned = tuned;
    std::string problem;
    try {
        // The filter's width in the picture stays: a level less for each halving of the resolution.
        Scene scene = *current.scene;
        const auto narrow = [&](int& levels) {
            for (int width = options.size.x; 2 * width <= current.size.x && levels > 1; width *= 2) --levels;
        };
        narrow(scene.settings.blur_levels);
        if (options.other) narrow(options.other->blur_levels);
        renderer->update(scene, options);
        unshown = true;
        noise_samples = 0;
        noise.reset();
    } catch (const std::exception& failure) {
        problem = failure.what();
        gave_up = true;
    }
    const std::lock_guard lock(mutex);
    error = problem;
    const double rate = options.size == last_size ? statistics.frames_per_second : 0.0;
    statistics = renderer->statistics();
    statistics.frames_per_second = rate;
}

/// When the hand rests: first the program with literals for the picture, then those that the next edit will need. One
/// kernel after the other, so that an edit does not have to wait for all of them. True when it did something.
bool RenderThread::State::compile_in_background() {
    if (current.interacting || gave_up || prepared || Clock::now() - request_time < rest) return false;
    const Scene& scene = *current.scene;
    const auto missing = [&](Tier tier, Id tuned) { return renderer->needs_compile(scene, tier, tuned); };
    if (!renderer->statistics().specialised) {
        if (missing(Tier::specialised, 0))
            compile_one(Tier::specialised, 0);
        else
            update(Tier::specialised, 0);
        return true;
    }
    const std::chrono::duration<double, std::milli> longer(patience * renderer->statistics().compile_milliseconds);
    if (Clock::now() - request_time < longer) return false;
    const int for_tuned = current.tuned && find_node(scene, current.tuned)
                              ? renderer->missing_programs(scene, Tier::specialised, current.tuned)
                              : 0;
    const bool tuned = for_tuned > 0 && for_tuned <= most_prepared;
    const bool live = !tuned && expanded_node_count(scene) <= largest_live_scene && missing(Tier::live, 0);
    prepared = !tuned && !live;
    if (prepared) return false;
    compile_one(tuned ? Tier::specialised : Tier::live, tuned ? current.tuned : 0);
    return true;
}

void RenderThread::State::compile_one(Tier tier, Id tuned) {
    try {
        renderer->compile_one(*current.scene, tier, tuned);
    } catch (const std::exception& failure) {
        gave_up = true;
        const std::lock_guard lock(mutex);
        error = failure.what();
    }
    const std::lock_guard lock(mutex);
    statistics.structural_compiles = renderer->statistics().structural_compiles;
    statistics.specialisations = renderer->statistics().specialisations;
    statistics.compile_milliseconds = renderer->statistics().compile_milliseconds;
}

/// Whether the picture is what the wish is for.
bool RenderThread::State::grants(const PictureWish& wish) const {
    return wish.room.x == 0 || wish.scene == current.scene;
}

/// With the mutex locked: whether a wish can be granted now.
bool RenderThread::State::can_write() {
    std::erase_if(wishes, [&](const PictureWish& w) { return w.scene && w.scene != asked_for; });
    return has_work() && !quick() && options.size == current.size && renderer->displayable() &&
           std::any_of(wishes.begin(), wishes.end(), [&](const PictureWish& w) { return grants(w); });
}

void RenderThread::State::write_pictures() {
    std::vector<PictureWish> granted;
    {
        const std::lock_guard lock(mutex);
        if (!can_write()) return;
        const auto rest = std::partition(wishes.begin(), wishes.end(), [&](const PictureWish& w) { return grants(w); });
        granted.assign(wishes.begin(), rest);
        wishes.erase(wishes.begin(), rest);
    }
    std::erase_if(writing, [](const std::future<void>& f) {
        return f.wait_for(std::chrono::seconds(0)) == std::future_status::ready;
    });
    for (const PictureWish& wish : granted) {
        Picture picture = wish.room.x > 0 ? read_small_picture(*renderer, wish.room)
                                          : read_picture(*renderer, options.view, is_linear(wish.file));
        writing.push_back(std::async(std::launch::async, [this, wish, picture = std::move(picture)] {
            std::string problem;
            try {
                write_picture(picture, wish.file);
            } catch (const std::exception& failure) {
                problem = failure.what();
            }
            const std::lock_guard lock(mutex);
            if (wish.room.x == 0) written.push_back({wish.file, problem});
        }));
    }
}

void RenderThread::State::wait_while_drawing() {
    std::unique_lock lock(mutex);
    // For one frame at most: the next may have begun.
    wake.wait_for(lock, longest_draw, [&, before = drawn] { return stop || !drawing || drawn != before; });
}

void RenderThread::State::work() {
    if (!has_work()) return;
    if (!finished()) {
        if (compile_in_background()) return;
        wait_while_drawing();
        if (renderer->step()) {
            estimate_noise();
            const Statistics& s = renderer->statistics();
            const double work_done = static_cast<double>(options.size.x) * options.size.y *
                                     (1 + (options.samples ? options.samples : current.scene->settings.samples));
            milliseconds_per_pixel_sample = s.frame_milliseconds / work_done;
            const std::lock_guard lock(mutex);
            const double rate = 1e3 / std::max(s.frame_milliseconds, 1e-3);
            const double smoothed =
                statistics.frames_per_second > 0.0 ? 0.8 * statistics.frames_per_second + 0.2 * rate : rate;
            statistics = s;
            statistics.frames_per_second = smoothed;
            statistics.noise = noise;
            // The first pictures and the last; of those between as many as come in time, because filtering one takes
            // longer than tracing a simple scene.
            unshown = unshown || quick() || preview || s.frames <= 2 || finished();
        }
    }
    write_pictures();
    const bool late = renderer->statistics().samples != shown_samples &&
                      Clock::now() - shown_time > std::max<Clock::duration>(longest_wait, 3 * show_time);
    if (!renderer->displayable() || !(unshown || late)) return;
    show();
    if (preview && renderer->statistics().frames > 0) {
        preview = false;
        update(options.tier, options.tuned);
    }
}

void RenderThread::State::estimate_noise() {
    const int samples = renderer->statistics().samples;
    if (quick() || !noise_due(samples, noise_samples)) return;
    const auto estimate = renderer->noise([this] {
        wait_while_drawing();
        return outdated();
    });
    if (!estimate) return;
    noise = estimate;
    noise_samples = samples;
}

/// Whether filtering the picture is in vain, because a newer request has come. Not twice in a row: something must be
/// seen.
bool RenderThread::State::outdated() {
    const std::lock_guard lock(mutex);
    return stop || (next && !quick() && !dropped);
}

void RenderThread::State::show() {
    int free = 0;
    {
        const std::lock_guard lock(mutex);
        while (free == ready || free == held) ++free;
    }
    Slot& slot = slots[static_cast<std::size_t>(free)];
    const auto fit = [&](gl::Texture& texture) {
        if (!texture || texture.size() != renderer->size())
            texture = gl::Texture("picture", GL_RGBA8, renderer->size());
    };
    fit(slot.texture);
    if (options.other)
        fit(slot.other);
    else
        slot.other = {};
    const Clock::time_point start = Clock::now();
    dropped = !renderer->display(slot.texture, slot.other, [this] {
        wait_while_drawing();
        return outdated();
    });
    unshown = dropped;
    if (dropped) return;
    shown_samples = renderer->statistics().samples;
    if (slot.fence) glDeleteSync(slot.fence);
    slot.fence = glFenceSync(GL_SYNC_GPU_COMMANDS_COMPLETE, 0);
    glFlush();
    slot.picture.texture = slot.texture.name();
    slot.picture.other = slot.other.name();
    slot.picture.size = renderer->size();
    slot.picture.serial = ++serial;
    slot.picture.view = options.view;
    slot.picture.beside = options.other;
    shown_time = Clock::now();
    show_time = shown_time - start;
    const std::lock_guard lock(mutex);
    ready = free;
    statistics.samples = shown_samples;
    if (!unseen_edit) return;
    edit_milliseconds = std::chrono::duration<double, std::milli>(shown_time - *unseen_edit).count();
    unseen_edit.reset();
}

}  // namespace farfield
