// What is selected, and what the editor does with it, without a window.
#include "app/selection_history.h"
#include "sdf/evaluate.h"
#include "sdf/history.h"
#include "sdf/scene_file.h"
#include "tests/test_support.h"
#include "ui/material_edits.h"
#include "ui/selection.h"
#include "ui/tree_edits.h"

#include <gtest/gtest.h>

namespace farfield {
namespace {

using Ids = std::vector<Id>;

/// scene: a, group: (b, c), d, e
struct Small {
    Scene scene;
    Id root = scene.root.id, a, group, b, c, d, e;

    Small() {
        a = add(NodeKind::sphere, "a", root);
        group = add(NodeKind::union_, "group", root);
        b = add(NodeKind::sphere, "b", group);
        c = add(NodeKind::box, "c", group);
        d = add(NodeKind::sphere, "d", root);
        e = add(NodeKind::torus, "e", root);
    }
    Id add(NodeKind kind, const char* name, Id parent) {
        Node node = make_node(kind);
        node.name = name;
        return apply(scene, InsertNode{parent, -1, node});
    }
    std::string names(Id parent) const {
        std::string text;
        for (const Node& child : find_node(scene, parent)->children) text += (text.empty() ? "" : " ") + child.name;
        return text;
    }
    static ObjectRef node(Id id) { return {ObjectType::node, id}; }
    /// Carries the edits out; returns what is selected then.
    Selection carry_out(const Edits& edits, const Selection& selection) {
        const Scene before = scene;
        const Ids results = apply_all(scene, edits);
        return selection_after(before, scene, edits, results, selection);
    }
};

TEST(Selection, WhoeverSelectsOneThingSelectsThatAlone) {
    Small s;
    Selection selection = select(Ids{s.a, s.b, s.d});
    EXPECT_EQ(selected_nodes(selection), (Ids{s.a, s.b, s.d}));
    EXPECT_EQ(selection.primary.id, s.d);
    selection.primary = Small::node(s.e);
    EXPECT_EQ(selected_nodes(selection), Ids{s.e});
    selection.primary = {ObjectType::light, s.d};
    EXPECT_TRUE(selected_nodes(selection).empty());
}

TEST(Selection, TogglesAndReaches) {
    Small s;
    Selection selection = toggled(select(Small::node(s.a)), s.d);
    EXPECT_EQ(selected_nodes(selection), (Ids{s.a, s.d}));
    EXPECT_EQ(selected_nodes(toggled(selection, s.a)), Ids{s.d});
    EXPECT_EQ(selected_nodes(toggled(selection, s.d)), Ids{s.a});
    EXPECT_EQ(selected_nodes(toggled(select(Small::node(s.a)), s.a)), Ids{s.a}) << "one stays";
    EXPECT_EQ(selected_nodes(toggled(select(ObjectRef{ObjectType::sky}), s.a)), Ids{s.a});

    const Ids rows{s.root, s.a, s.group, s.b, s.c, s.d, s.e};
    EXPECT_EQ(selected_nodes(extended(select(Small::node(s.c)), rows, s.a)), (Ids{s.a, s.group, s.b, s.c}));
    EXPECT_EQ(selected_nodes(extended(select(Small::node(s.c)), rows, s.e)), (Ids{s.d, s.e, s.c}));
    EXPECT_EQ(selected_nodes(extended(select(Small::node(4242)), rows, s.e)), Ids{s.e});

    selection = everything(s.scene, select(Small::node(s.b)));
    EXPECT_EQ(selected_nodes(selection), (Ids{s.b, s.c}));
    EXPECT_EQ(selected_nodes(everything(s.scene, selection)), (Ids{s.a, s.group, s.d, s.e}));
}

TEST(TreeEdits, OfNodesInEachOtherTheOuterOneCounts) {
    Small s;
    const Selection selection = select(Ids{s.b, s.group, s.d});
    const Selection after = s.carry_out(delete_selection(s.scene, selection), selection);
    EXPECT_EQ(s.names(s.root), "a e");
    EXPECT_EQ(selected_nodes(after), Ids{s.e}) << "the neighbour";
}

TEST(TreeEdits, DuplicatesStandBehindTheirOriginalsAndAreSelected) {
    Small s;
    const Selection selection = select(Ids{s.d, s.b});
    const Selection after = s.carry_out(duplicate_selection(s.scene, selection), selection);
    EXPECT_EQ(s.names(s.root), "a group d d 2 e");
    EXPECT_EQ(s.names(s.group), "b b 2 c");
    ASSERT_EQ(selected_nodes(after).size(), 2u);
    for (const Id id : selected_nodes(after)) EXPECT_TRUE(find_node(s.scene, id)->name.ends_with(" 2"));
}

TEST(TreeEdits, ShiftedNodesKeepTheirOrderAndStopAtTheEnd) {
    Small s;
    const Selection selection = select(Ids{s.a, s.d});
    const auto shift = [&](int by) { apply_all(s.scene, shift_selection(s.scene, selection, by)); };
    shift(-1);
    EXPECT_EQ(s.names(s.root), "a d group e");
    EXPECT_TRUE(shift_selection(s.scene, selection, -1).empty());
    shift(1);
    EXPECT_EQ(s.names(s.root), "group a d e");
    shift(1);
    EXPECT_EQ(s.names(s.root), "group e a d");
    EXPECT_TRUE(shift_selection(s.scene, selection, 1).empty());
}

TEST(TreeEdits, DroppedNodesKeepTheirOrderWhereverTheyGo) {
    const std::pair<int, const char*> wanted[] = {
        {0, "a d e group"}, {1, "a d e group"}, {2, "group a d e"}, {3, "group a d e"}, {-1, "group a d e"}};
    for (const auto& [index, names] : wanted) {
        Small s;
        apply_all(s.scene, move_nodes(s.scene, {s.e, s.a, s.d}, s.root, index));
        EXPECT_EQ(s.names(s.root), names) << index;
    }
    Small s;
    apply_all(s.scene, move_nodes(s.scene, {s.d, s.a, s.b}, s.group, 1));
    EXPECT_EQ(s.names(s.group), "a b d c");
    EXPECT_THROW(apply_all(s.scene, move_nodes(s.scene, {s.e, s.group}, s.group, 0)), EditError);
}

TEST(TreeEdits, DroppedNodesStayWhereTheyAreInSpace) {
    Small s;
    apply(s.scene, SetValue{Small::node(s.group), "translate", glm::vec3(1.0f, 2.0f, 3.0f)});
    apply(s.scene, SetValue{Small::node(s.group), "rotate", glm::vec3(0.0f, 90.0f, 0.0f)});
    apply(s.scene, SetValue{Small::node(s.group), "scale", glm::vec3(2.0f, 0, 0)});
    apply(s.scene, SetValue{Small::node(s.d), "translate", glm::vec3(0.5f, 0.0f, 0.0f)});
    const Edits edits = move_nodes(s.scene, {s.d}, s.group, -1);
    EXPECT_EQ(describe(s.scene, edits), "move d");
    apply_all(s.scene, edits);
    const Transform t = find_node(s.scene, s.d)->transform;
    // A quarter turn about y takes z to x.
    EXPECT_EQ(t.translate, glm::vec3(1.5f, -1.0f, -0.25f));
    EXPECT_EQ(t.rotate, glm::vec3(0.0f, -90.0f, 0.0f));
    EXPECT_EQ(t.scale, 0.5f);
    apply_all(s.scene, move_nodes(s.scene, {s.d}, s.root, 0));
    EXPECT_EQ(value(s.scene, Small::node(s.d), "translate"), glm::vec3(0.5f, 0.0f, 0.0f));
    EXPECT_EQ(value(s.scene, Small::node(s.d), "rotate"), glm::vec3(0.0f));
}

TEST(TreeEdits, GroupsAndDissolvesWithTheSelection) {
    Small s;
    Selection selection = select(Ids{s.d, s.a});
    selection = s.carry_out(group_selection(s.scene, selection), selection);
    EXPECT_EQ(s.names(s.root), "group 2 group e");
    EXPECT_EQ(find_node(s.scene, selection.primary.id)->name, "group 2");
    selection = s.carry_out(dissolve_selection(s.scene, selection), selection);
    EXPECT_EQ(s.names(s.root), "a d group e");
    EXPECT_EQ(selected_nodes(selection), (Ids{s.a, s.d}));
    selection = s.carry_out(wrap_selection(s.scene, selection, NodeKind::twist), selection);
    EXPECT_EQ(find_node(s.scene, selection.primary.id)->kind, NodeKind::twist);
}

TEST(TreeEdits, AGroupKeepsThePictureOfWhateverItIsIn) {
    for (const KindInfo& kind : node_kinds()) {
        if (kind.role != Role::combine) continue;
        for (const bool blended : {false, true}) {
            Small s;
            const Id all = s.add(kind.kind, "all", s.root);
            Ids shapes;
            for (const Id id : {s.a, s.d, s.e}) shapes.push_back(id);
            apply_all(s.scene, move_nodes(s.scene, shapes, all, -1));
            if (blended && !kind.parameters.empty())
                apply(s.scene, SetValue{Small::node(all), kind.parameters[0].key, glm::vec3(0.2f)});
            apply(s.scene, SetValue{Small::node(s.d), "translate", glm::vec3(0.5f, 0.2f, 0.0f)});
            for (const Ids& grouped : {Ids{s.a, s.d}, Ids{s.d, s.e}}) {
                // Blends, pipes and the like are made one after the other.
                const bool hard = !blended && (kind.when_zero || kind.kind == NodeKind::xor_);
                if (!hard && grouped[0] != s.a) continue;
                Scene after = s.scene;
                apply_all(after, group_selection(after, select(grouped)));
                ASSERT_EQ(find_node(after, all)->children.size(), 2u) << kind.key;
                const FieldEvaluator was(s.scene), is(after);
                for (float x = -2.0f; x <= 2.0f; x += 0.1f)
                    for (const glm::vec3 p : {glm::vec3(x, 0.3f, 0.1f), glm::vec3(0.2f, x, 0.3f)})
                        ASSERT_NEAR(was.distance(p), is.distance(p), 1e-5f) << kind.key << " " << x;
            }
        }
    }
}

TEST(TreeEdits, HidesWhatShowsAndShowsWhatIsHidden) {
    Small s;
    const Selection selection = select(Ids{s.root, s.a, s.d});
    apply(s.scene, SetHidden{s.a, true});
    apply_all(s.scene, hide_selection(s.scene, selection));
    EXPECT_TRUE(find_node(s.scene, s.a)->hidden && find_node(s.scene, s.d)->hidden && !s.scene.root.hidden);
    apply_all(s.scene, hide_selection(s.scene, selection));
    EXPECT_FALSE(find_node(s.scene, s.a)->hidden || find_node(s.scene, s.d)->hidden);
    apply_all(s.scene, show_only_selection(s.scene, select(Small::node(s.b))));
    EXPECT_TRUE(find_node(s.scene, s.a)->hidden && find_node(s.scene, s.c)->hidden);
    EXPECT_FALSE(find_node(s.scene, s.group)->hidden || find_node(s.scene, s.b)->hidden);
    apply_all(s.scene, show_only_selection(s.scene, select(Small::node(s.b))));
    EXPECT_TRUE(show_everything(s.scene).empty()) << "the second time shows everything";
}

TEST(TreeEdits, WhatIsCutAndPastedIsTheSame) {
    Small s;
    const std::string before = to_text(s.scene);
    const Selection selection = select(Ids{s.d, s.e});
    const std::string text = copied_selection(s.scene, selection);
    Selection after = s.carry_out(delete_selection(s.scene, selection), selection);
    EXPECT_EQ(selected_nodes(after), Ids{s.group});
    after = s.carry_out(paste_at_selection(s.scene, after, text), after);
    EXPECT_EQ(to_text(s.scene), before);
    EXPECT_EQ(selected_nodes(after).size(), 2u);
    EXPECT_THROW(paste_at_selection(s.scene, after, "{"), EditError);
    EXPECT_TRUE(copied_selection(s.scene, select(ObjectRef{ObjectType::sky})).empty());
}

TEST(TreeEdits, OneValueChangesInAllOfTheKind) {
    Small s;
    const Id red = apply(s.scene, AddMaterial{{0, "red"}});
    apply(s.scene, SetValue{Small::node(s.a), "translate", glm::vec3(1.0f, 2.0f, 3.0f)});
    const Selection selection = select(Ids{s.a, s.c, s.d});
    const auto change = [&](Edit edit) { apply_all(s.scene, for_all_selected(s.scene, selection, {std::move(edit)})); };
    const auto of = [&](Id id, const char* key) { return value(s.scene, Small::node(id), key); };
    change(SetValue{Small::node(s.d), "radius", glm::vec3(0.2f, 0, 0)});
    EXPECT_EQ(of(s.a, "radius").x, 0.2f);
    EXPECT_EQ(find_node(s.scene, s.c)->values, make_node(NodeKind::box).values);
    change(SetValue{Small::node(s.d), "translate", glm::vec3(0.0f, 1.0f, 0.0f)});
    EXPECT_EQ(of(s.a, "translate"), glm::vec3(1.0f, 3.0f, 3.0f)) << "all move by as much";
    EXPECT_EQ(of(s.c, "translate"), glm::vec3(0.0f, 1.0f, 0.0f));
    change(SetValue{Small::node(s.d), "scale", glm::vec3(2.0f, 0, 0)});
    EXPECT_EQ(of(s.c, "scale").x, 2.0f);
    change(SetValue{Small::node(s.d), "scale", glm::vec3(1e4f, 0, 0)});
    change(SetValue{Small::node(s.d), "scale", glm::vec3(1e-4f, 0, 0)});
    EXPECT_EQ(of(s.c, "scale").x, 1e-4f) << "in its range";
    change(SetMaterial{s.d, red});
    change(SetKind{s.d, NodeKind::cone});
    for (const Id id : {s.a, s.c, s.d}) {
        EXPECT_EQ(find_node(s.scene, id)->material, red);
        EXPECT_EQ(find_node(s.scene, id)->kind, NodeKind::cone);
    }
    EXPECT_EQ(find_node(s.scene, s.e)->kind, NodeKind::torus);
}

TEST(TreeSearch, FindsNamesAndKindsWhateverTheirCase) {
    Small s;
    const auto found = [&](Id id, const char* words) { return matches(s.scene, *find_node(s.scene, id), words); };
    EXPECT_TRUE(found(s.group, "GRO"));
    EXPECT_TRUE(found(s.group, "union group"));
    EXPECT_TRUE(found(s.e, "tor"));
    EXPECT_TRUE(found(s.e, ""));
    EXPECT_FALSE(found(s.e, "tor box"));
}

TEST(Selection, StaysWhenABookmarkIsAdded) {
    Small s;
    const Selection selection = select(Ids{s.a, s.b});
    EXPECT_EQ(s.carry_out({AddBookmark{}}, selection), selection);
}

TEST(Materials, AreGivenToWhatIsSelectedOrToTheNodeTheyAreDroppedOn) {
    Small s;
    const Id red = apply(s.scene, AddMaterial{{0, "red"}});
    const auto users = [&] { return material_users(s.scene, red); };
    const Selection selection = select(Ids{s.c, s.a});
    EXPECT_EQ(s.carry_out(give_material(s.scene, selection, red), selection), selection);
    EXPECT_EQ(users(), (Ids{s.a, s.c}));
    EXPECT_TRUE(give_material(s.scene, selection, red).empty()) << "they have it";
    EXPECT_TRUE(give_material(s.scene, select(ObjectRef{ObjectType::material, red}), red).empty());

    s.carry_out(drop_material(s.scene, selection, s.e, red), selection);
    EXPECT_EQ(users(), (Ids{s.a, s.c, s.e})) << "on one that is not selected";
    s.carry_out(drop_material(s.scene, select(Ids{s.b, s.d}), s.b, red), selection);
    EXPECT_EQ(users(), (Ids{s.a, s.b, s.c, s.d, s.e})) << "on one of several that are";
    EXPECT_EQ(material_uses(s.scene).at(red), 5);
    EXPECT_FALSE(material_uses(s.scene).contains(s.scene.materials[0].id));
}

TEST(Materials, ANewOneIsTheNodesAndIsSelected) {
    Small s;
    const Selection both = select(Ids{s.a, s.b});
    const Selection after = s.carry_out(for_all_selected(s.scene, both, new_material(s.scene, s.b)), both);
    ASSERT_EQ(after.primary.type, ObjectType::material);
    EXPECT_EQ(material_users(s.scene, after.primary.id), (Ids{s.a, s.b}));
}

TEST(Materials, WhatBecomesOfNodesWithoutTheirsIsSaid) {
    Small s;
    const Id first = s.scene.materials[0].id, red = apply(s.scene, AddMaterial{{0, "red"}});
    EXPECT_EQ(without_material(s.scene, red, 0), "");
    EXPECT_EQ(without_material(s.scene, red, 1), "Without it the node that has it takes the material of its group.");
    EXPECT_EQ(without_material(s.scene, first, 0), "Nodes without any then have red.");
    apply(s.scene, RemoveMaterial{first});
    EXPECT_EQ(without_material(s.scene, red, 0), "The last material stays.");
}

TEST(SelectionHistory, UndoBringsBackWhatWasSelectedAtEachStep) {
    std::mt19937 random(9);
    History history(random_scene(4, 14));
    SelectionHistory selections;
    std::vector<Selection> before{Selection{}}, after{Selection{}};  // of each step, from 1
    while (before.size() < 80) {
        const Ids ids = all_ids(history.scene());
        const Selection selection = select(Ids{ids[random() % ids.size()], ids[random() % ids.size()]});
        const Edits edits{random_edit(history.scene(), random)};
        const Scene scene = history.scene();
        const std::size_t position = history.position();
        const auto gesture = static_cast<unsigned>(random() % 3);
        try {
            const Ids results = history.apply(edits, gesture);
            const Selection now = selection_after(scene, history.scene(), edits, results, selection);
            const bool went_on = history.position() == position;
            selections.done(history.position(), went_on, selection, now);
            if (!went_on) before.push_back(selection), after.emplace_back();
            after.back() = now;
        } catch (const EditError&) {}
    }
    std::size_t at = history.position();
    for (int i = 0; i < 300; ++i) {
        const std::size_t to = random() % before.size();
        if (to == at) continue;
        EXPECT_EQ(selections.at(at, to), to < at ? before[to + 1] : after[to]);
        at = to;
    }
}

}  // namespace
}  // namespace farfield
