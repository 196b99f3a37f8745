// Undo and redo of whole scenes, and the list of steps.
#pragma once

#include "sdf/edit.h"
#include "sdf/packed_scene.h"

#include <cstdint>

namespace farfield {

/// Keeping scenes beats inverting edits: packed, each step costs what it changed, and a few bytes for each node.
class History {
public:
    explicit History(Scene scene = {});
    const Scene& scene() const { return scene_; }
    /// One step. Edits that carry the same non-zero `gesture` (one drag of a slider) make one together.
    std::vector<Id> apply(std::span<const Edit> edits, unsigned gesture = 0);
    Id apply(const Edit& edit, unsigned gesture = 0);
    /// Takes the step of this gesture back and forgets it, if it is the latest.
    void cancel(unsigned gesture);
    void replace(Scene scene);  ///< a new document: forgets all steps
    /// A step that was made elsewhere.
    void record(Scene scene, std::string description);
    bool can_undo() const { return current_ > 0; }
    bool can_redo() const { return current_ + 1 < steps_.size(); }
    void undo();
    void redo();
    /// To the state after so many steps, 0 being the start; what lies behind can be redone.
    void go_to(std::size_t step);
    std::size_t position() const { return current_; }
    /// Of all steps, those that could be redone included.
    std::size_t size() const { return steps_.size() - 1; }
    /// What the step that leads to this position was, from 1.
    const std::string& description(std::size_t step) const { return steps_[step].description; }
    /// Descriptions of the steps that undo would revert, oldest first.
    std::vector<std::string> steps() const;
    /// Changes with every edit, undo, redo and replace; equal revisions mean equal scenes.
    std::uint64_t revision() const { return steps_[current_].revision; }

private:
    /// Makes `scene` the latest step, in place of all that could be redone.
    void add(Scene scene, std::string description, unsigned gesture);
    struct Step {
        PackedScene scene;
        std::string description;
        unsigned gesture;
        std::uint64_t revision;
    };
    std::vector<Step> steps_;  ///< the state after each step; the first is the start
    std::size_t current_ = 0;
    Scene scene_;  ///< that of the current step
    std::uint64_t next_revision_ = 1;
};

}  // namespace farfield
