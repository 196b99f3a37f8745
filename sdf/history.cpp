#include "sdf/history.h"

#include <algorithm>
#include <utility>

namespace farfield {

History::History(Scene scene) { replace(std::move(scene)); }

std::vector<Id> History::apply(std::span<const Edit> edits, unsigned gesture) {
    if (edits.empty()) return {};
    Scene changed = scene_;
    std::vector<Id> ids = apply_all(changed, edits);
    const bool continues = gesture != 0 && current_ > 0 && steps_[current_].gesture == gesture;
    std::string description = continues ? std::move(steps_[current_].description) : describe(scene_, edits);
    if (continues) --current_;
    add(std::move(changed), std::move(description), gesture);
    return ids;
}

void History::record(Scene scene, std::string description) {
    scene.next_id = std::max(scene.next_id, scene_.next_id);
    add(std::move(scene), std::move(description), 0);
}

void History::add(Scene scene, std::string description, unsigned gesture) {
    Step step{PackedScene(scene, steps_[current_].scene), std::move(description), gesture, next_revision_++};
    ++current_;
    steps_.erase(steps_.begin() + static_cast<std::ptrdiff_t>(current_), steps_.end());
    steps_.push_back(std::move(step));
    scene_ = std::move(scene);
}

Id History::apply(const Edit& edit, unsigned gesture) { return apply(std::span(&edit, 1), gesture).front(); }

void History::cancel(unsigned gesture) {
    if (gesture == 0 || current_ == 0 || current_ != size() || steps_[current_].gesture != gesture) return;
    go_to(current_ - 1);
    steps_.pop_back();
}

void History::replace(Scene scene) {
    steps_.clear();
    steps_.push_back({PackedScene(scene), "", 0, next_revision_++});
    current_ = 0;
    scene_ = std::move(scene);
}

void History::undo() {
    if (can_undo()) go_to(current_ - 1);
}

void History::redo() {
    if (can_redo()) go_to(current_ + 1);
}

void History::go_to(std::size_t step) {
    current_ = std::min(step, size());
    // Identifiers are never reused, not even by an edit that follows an undo.
    const Id next_id = scene_.next_id;
    scene_ = steps_[current_].scene.unpacked();
    scene_.next_id = std::max(scene_.next_id, next_id);
}

std::vector<std::string> History::steps() const {
    std::vector<std::string> descriptions;
    for (std::size_t i = 1; i <= current_; ++i) descriptions.push_back(steps_[i].description);
    return descriptions;
}

}  // namespace farfield
