// The stability run as a table: a case is a family of scenes with one parameter, a figure for each method, and the most
// that the figure may come to. Every row of the list of places where such methods are known to fail has its cases.
#pragma once

#include "tests/stability/stage.h"

#include <array>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace farfield::stability {

/// A value of the swept parameter; `label` where it is no number.
struct Point {
    Point(double v) : value(v) {}  // NOLINT: a list of numbers is a sweep
    Point(double v, std::string text) : value(v), label(std::move(text)) {}
    double value;
    std::string label;
};

/// What was measured at one value, by method; nothing where a method has no such figure.
struct Figures {
    std::array<std::optional<double>, 3> by_method;
    std::string note;  ///< what else happened, as an error's message
    std::optional<double>& operator[](Method method) { return by_method[static_cast<std::size_t>(method)]; }
    std::optional<double> operator[](Method method) const { return by_method[static_cast<std::size_t>(method)]; }
};

/// Of what all methods share, as the tracer.
inline Figures shared(double value, std::string note = {}) { return {{value, value, value}, std::move(note)}; }

struct Case {
    std::string key;        ///< names it on the command line and in the CSV
    std::string failure;    ///< what is known to break
    std::string parameter;  ///< with its unit
    std::vector<Point> values;
    std::string measured;  ///< with its unit; smaller is better
    std::function<Figures(Stage&, const Point&)> measure;
    /// What `farfield`, and `reference` where it has a figure, may come to at most.
    std::function<double(const Point&)> bound;
    bool quick = false;   ///< part of the test suite
    std::string known{};  ///< where the bound is known to be missed: why, and what to do
};

inline std::function<double(const Point&)> at_most(double bound) {
    return [bound](const Point&) { return bound; };
}

// The table, by subject.
std::vector<Case> field_cases();
std::vector<Case> precision_cases();
std::vector<Case> extreme_cases();
std::vector<Case> closed_form_cases();
std::vector<Case> light_cases();
std::vector<Case> temporal_cases();
std::vector<Case> driver_cases(double soak_minutes);

}  // namespace farfield::stability
