// What an audit says about the open scene, for all panels: what follows from the numbers with every change, what takes
// trying when someone asks for it, on a thread of its own.
#pragma once

#include "sdf/audit.h"

#include <atomic>
#include <cstdint>
#include <future>
#include <map>
#include <memory>
#include <string>
#include <vector>

namespace farfield {

class SceneAudit {
public:
    SceneAudit() = default;
    ~SceneAudit() { cancel(); }
    SceneAudit(const SceneAudit&) = delete;
    SceneAudit& operator=(const SceneAudit&) = delete;

    /// Looks at the scene when its shapes are others than before; `revision` tells without looking that nothing has
    /// changed. Takes over what the thread has found. `now`: seconds; where a scene takes long it is not looked at each
    /// time.
    /// `picture_height`: of the picture in pixels.
    void refresh(const std::shared_ptr<const Scene>& scene, std::uint64_t revision, int picture_height, double now);
    /// Begins to try points of every node.
    void start();
    bool running() const { return run_.valid(); }
    bool finished() const;  ///< there is something for refresh to take over
    bool sampled() const { return sampled_; }

    const NodeAudit* find(Id node) const;
    /// Empty where there are none.
    const std::vector<Finding>& warnings(Id node) const;

private:
    void cancel();
    void show(Audit audit);
    void note_warnings();

    std::shared_ptr<const Scene> scene_;
    std::uint64_t revision_ = 0;
    std::string shapes_;  ///< the scene as text, without what no audit depends on
    double next_ = 0.0;   ///< when it may be looked at again
    bool sampled_ = false;
    Audit audit_;
    std::vector<Finding> of_view_;  ///< what hangs on the camera
    std::map<Id, const NodeAudit*> nodes_;
    std::map<Id, std::vector<Finding>> warnings_;
    std::atomic<bool> stop_{false};
    std::future<Audit> run_;
};

}  // namespace farfield
