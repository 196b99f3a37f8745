// What is alike in a large scene. The nodes that hard unions unite, each with all below it, are written as code; those
// whose code is the same but for its numbers are one family, which is one program and a table of numbers. So a thousand
// spheres take the compiler no longer than one, a member that moves needs no new program, and a ray evaluates those
// members alone whose bounds it meets (sdf/box_tree.h).
//
// A number is read from the table where the members differ, and stands in the code where they do not. Numbers that are
// the same within each member, such as a place that is used three times, stand in the table once.
#pragma once

#include "sdf/codegen.h"
#include "sdf/field_tree.h"

#include <string>
#include <unordered_map>
#include <vector>

namespace farfield {

/// Which of a code's numbers stand in the table.
struct NumberLayout {
    std::vector<int> places;  ///< for each number of the code: which of a member's in the table, or -1: it is a literal
    std::vector<float> literals;  ///< the numbers themselves where they are
    int width = 0;                ///< numbers of each member
};

struct Family {
    std::vector<Id> members;     ///< their topmost nodes
    std::vector<Box> bounds;     ///< of each, world frame
    GeneratedScene code;         ///< of the first, with what differs read from `member0`, `member1`, ...
    std::vector<float> numbers;  ///< the table: 4 x code.member_vectors for each member
};

/// Finds the families of scene after scene: what an edit has not touched is not written as code once more, and a layout
/// that serves still is used again, so that an edit that makes members more alike needs no new program.
class FamilyFinder {
public:
    /// All families of the scene. Nodes without an end are in none, nor is what contains node `tuned`.
    std::vector<Family> find(const Scene& scene, Id tuned = 0);

private:
    /// What hard unions unite, at the origin.
    struct Item {
        FieldTree tree;
        int code;
        std::size_t nodes;
        std::vector<float> numbers;
    };
    Item make_item(FieldTree tree);

    std::unordered_map<std::string, int> codes_;  ///< without numbers
    std::unordered_map<int, NumberLayout> layouts_;
    std::unordered_map<Id, Item> items_;  ///< of the last scene, by their topmost nodes
};

}  // namespace farfield
