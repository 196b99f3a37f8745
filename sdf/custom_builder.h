// The instructions of a CustomProgram while it is made: places in memory, temporaries, constants and jumps. Like the
// other headers that include glslang's tree it is for the compiler's own files.
#pragma once

#include "sdf/custom_compiler.h"
#include "sdf/custom_ranges.h"

#include <glslang/Include/intermediate.h>

#include <map>
#include <vector>

namespace farfield::custom {

using namespace glslang;
using O = Operation;

/// Where a value lies. A scalar operand serves for all components of a vector.
struct Value {
    int at = 0;
    int cells = 0;
    TBasicType base = EbtVoid;
};

/// A value that may be assigned to: cells at a fixed place, at one that depends on an index, or picked by a swizzle.
struct Place {
    Value value;
    int offset = no_offset;
    std::vector<int> selectors = {};  ///< relative to value.at
};

struct Function {
    TIntermAggregate* node = nullptr;
    enum { unknown, open, done, broken } state = unknown;
    std::vector<Value> parameters;
    Value result;
    int start = 0;
    std::size_t depth = 0;  ///< of calls below
    double operations = 0.0, repetitions = 0.0, inlined = 0.0;
};

/// Size of a value; refuses types that distance code cannot have.
int cells_of(const TType& type, int line);

class Builder {
protected:
    using Labels = std::vector<std::size_t>;
    /// Of an operation on whole vectors.
    struct Shape {
        int n, cells;
        TBasicType base;
    };

    int allocate(const TType& type, int line);
    void check_size(int line) const;
    std::size_t emit(const Instruction& instruction);
    int here() const;
    void land(const Labels& jumps);
    /// Temporaries lie after the variables of their function and are free again after each statement.
    Value temporary(int cells, TBasicType base);
    Value constant(const std::vector<Cell>& cells, TBasicType base);
    Value constant(float v);
    Value constant(TBasicType base, int v);
    Value componentwise(Operation operation, const std::vector<Value>& args, TBasicType base);
    void move(int to, int from, int cells);
    Value copy(const Value& value);
    static int packed(const std::vector<int>& selectors);
    Value load(const Place& p);
    /// Answers the value, in a place that the store has not changed.
    Value store(const Place& p, Value value);
    static Place narrowed(Place p, const TType& type, int line);
    static Place picked(Place p, std::vector<int> selectors);
    Value whole(Operation operation, const std::vector<Value>& args, const Shape& shape);
    Value matrix(Operation operation, const std::vector<Value>& args, int rows, int columns, int n);
    /// Adds to `result` whether the values of one type at a + at and b + at are equal; floats compare as numbers.
    void compare(const TType& type, int a, int b, int& at, Value& result, int line);
    Value converted(const Value& v, TBasicType to);

    CustomProgram program_;
    Function* current_ = nullptr;
    double factor_ = 1.0;  ///< how often the code that is being compiled runs in one call of its function
    int first_temporary_ = 0, next_temporary_ = 0;  ///< of the current function
    int statement_line_ = 1;

private:
    std::map<std::vector<Cell>, int> constants_;
};

}  // namespace farfield::custom
