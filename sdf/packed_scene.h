// Scenes that share what is equal. A step of undo changes a node or two of hundreds: kept whole, ten thousand steps of
// a scene of 200 nodes would take a gigabyte; packed, they take a few pointers for each node and step.
#pragma once

#include "sdf/scene.h"

#include <memory>
#include <vector>

namespace farfield {

class PackedScene {
public:
    explicit PackedScene(const Scene& scene);
    /// Shares with `similar` the subtrees that are equal there, found by their ids.
    PackedScene(const Scene& scene, const PackedScene& similar);

    Scene unpacked() const;

private:
    struct Part;
    using Parts = std::vector<std::shared_ptr<const Part>>;
    struct Part {
        Node node;  ///< without its children
        Parts children;
    };
    class Packer;
    static Node unpacked(const Part& part);

    std::shared_ptr<const Scene> rest_;  ///< all but the nodes
    std::shared_ptr<const Part> root_;
    Parts definitions_;
    Id next_id_;
};

}  // namespace farfield
