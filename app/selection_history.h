// What was selected at each step, so that undo and redo bring back what one worked on with the work.
#pragma once

#include "ui/selection.h"

#include <vector>

namespace farfield {

class SelectionHistory {
public:
    void clear() { steps_.clear(); }

    /// The step that leads to `position` was done, or went on where that was done before it.
    void done(std::size_t position, bool went_on, const Selection& before, const Selection& after) {
        steps_.resize(position);
        Step& step = steps_.back();
        if (!went_on) step.before = before;
        step.after = after;
    }

    /// What was selected when the history was last left for another `position`: before the step that was taken back
    /// last, or after the one that was done again last. Nothing where that step was not the user's, as a reload.
    Selection at(std::size_t from, std::size_t position) const {
        const std::size_t step = position < from ? position : position - 1;
        if (step >= steps_.size()) return {};
        return position < from ? steps_[step].before : steps_[step].after;
    }

private:
    struct Step {
        Selection before, after;
    };
    std::vector<Step> steps_;
};

}  // namespace farfield
