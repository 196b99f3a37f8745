// What undo brings back, in all that hangs on a scene: its file, the generated code of both tiers, the parameters.
#include "sdf/codegen.h"
#include "sdf/history.h"
#include "sdf/scene_file.h"
#include "tests/test_support.h"

#include <gtest/gtest.h>

#include <array>
#include <set>

namespace farfield {
namespace {

/// All that is derived from a scene. The names in the code come from the tree, not from ids, so equal trees give equal
/// code.
struct Snapshot {
    explicit Snapshot(const Scene& scene) : file(to_text(scene)) {
        for (const Tier tier : {Tier::live, Tier::specialised}) {
            GeneratedScene generated = generate(scene, tier);
            code += generated.text;
            keys += generated.key;
            if (tier == Tier::live) parameters = std::move(generated.parameters);
            lines = std::move(generated.line_nodes);
        }
    }
    friend bool operator==(const Snapshot&, const Snapshot&) = default;

    std::string file, code, keys;
    std::vector<float> parameters;
    std::vector<Id> lines;  ///< the nodes that the code's lines belong to, by id: undo brings the same nodes back
};

TEST(Undo, EveryStepBackAndForthEqualsTheSceneOfThatTime) {
    std::set<std::size_t> kinds_of_edits;
    int refused = 0;
    for (const unsigned seed : {1u, 2u, 3u, 4u, 5u}) {
        std::mt19937 random(seed);
        Scene start = random_scene(seed, 12);
        apply(start, InsertNode{start.root.id, -1, make_node(NodeKind::custom)});  // which is rare among the kinds
        History history(start);
        std::vector<Snapshot> snapshots{Snapshot(history.scene())};
        for (int i = 0; i < 200; ++i) {
            const Edit edit = random_edit(history.scene(), random);
            try {
                history.apply(edit);
            } catch (const EditError&) {
                ASSERT_EQ(Snapshot(history.scene()), snapshots.back()) << "refused edit " << i;
                ++refused;
                continue;
            }
            kinds_of_edits.insert(edit.index());
            snapshots.emplace_back(history.scene());
        }
        ASSERT_GT(snapshots.size(), 50u);
        ASSERT_EQ(history.steps().size(), snapshots.size() - 1);
        for (std::size_t step = snapshots.size() - 1; step > 0; --step) {
            history.undo();
            ASSERT_EQ(Snapshot(history.scene()), snapshots[step - 1])
                << "seed " << seed << ", back to step " << step - 1;
        }
        EXPECT_FALSE(history.can_undo());
        for (std::size_t step = 1; step < snapshots.size(); ++step) {
            history.redo();
            ASSERT_EQ(Snapshot(history.scene()), snapshots[step]) << "seed " << seed << ", forth to step " << step;
        }
        EXPECT_FALSE(history.can_redo());
    }
    EXPECT_EQ(kinds_of_edits.size(), std::variant_size_v<Edit>) << "not every kind of edit was carried out";
    EXPECT_GT(refused, 50);
}

}  // namespace
}  // namespace farfield
