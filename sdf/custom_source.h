// The text level of custom code: tokens, global declarations and parameter descriptions, and everything that can be
// refused without knowing a type. What passes consists only of words that distance code may use, is nested no deeper
// and has no longer statements than a recursive parser can take, and has no preprocessor line.
#pragma once

#include "sdf/parameter.h"

#include <cstddef>
#include <set>
#include <string>
#include <string_view>
#include <vector>

namespace farfield {

inline constexpr std::size_t most_uniforms = 64;

struct CodeError {
    int line;  ///< in the user's text, from 1
    std::string message;
};

using Names = std::set<std::string, std::less<>>;

/// Tokens of the text, by number, both inclusive.
struct TokenRange {
    std::size_t first, last;
};

/// A uniform declaration: one parameter of the node.
struct CustomUniform {
    std::string name;
    std::string type;  ///< float, int, bool, vec3, ivec3 or bvec3
    std::string tip;
    Unit unit = Unit::none;
    bool has_range = false;
    float minimum = 0.0f, maximum = 0.0f;
    int line = 0;
    TokenRange tokens{};  ///< from `uniform` to the semicolon
    std::size_t name_token = 0;
};

class CustomSource {
public:
    /// Reads `text`; what is wrong with it is added to `errors`, and then the rest must not be used.
    CustomSource(std::string_view text, std::vector<CodeError>& errors);

    const std::string& text() const { return text_; }  ///< with \n for line ends, the last line included
    int lines() const;
    const std::vector<CustomUniform>& uniforms() const { return uniforms_; }
    const Names& globals() const { return globals_; }  ///< of functions too
    int first_line(std::string_view name) const;       ///< where the name stands first; 1 where it does not
    /// Names that are used but not declared globally: local names, built-in functions and those of the shape library.
    Names foreign_names() const;

    /// The text with "_" + suffix after each of `names` where it is not a member. Other names that end so get one too:
    /// that keeps different names different. Each uniform's declaration becomes declarations[i] where there is one,
    /// with {} for the name. Lines stay where they are.
    std::string renamed(const Names& names, std::string_view suffix,
                        const std::vector<std::string>& declarations = {}) const;

private:
    enum class Kind { name, number, symbol };
    struct Token {
        Kind kind;
        std::size_t start, length;
        int line;
        bool member = false;  ///< a name after a dot or declared in a structure
    };
    struct Comment {
        std::size_t start, length;
        int line;
    };

    void fail(int line, std::string message) { errors_.push_back({line, std::move(message)}); }
    void normalise(std::string_view text);
    void tokenise();
    void check_words();
    void check_nesting();
    void read_declarations();
    std::size_t read_structure(std::size_t at);
    std::size_t read_uniform(std::size_t at);
    std::size_t read_constants(std::size_t at);
    std::size_t read_function(std::size_t at);
    void describe(CustomUniform& uniform);
    std::string_view comment_after(std::size_t token) const;

    std::string_view word(std::size_t i) const;  ///< empty past the end
    bool is_name(std::size_t i) const { return i < tokens_.size() && tokens_[i].kind == Kind::name; }
    int line_of(std::size_t i) const { return i < tokens_.size() ? tokens_[i].line : lines(); }
    std::size_t skip_brackets(std::size_t at) const;
    std::size_t skip_to(std::size_t at, std::string_view end) const;

    std::string text_;
    std::vector<Token> tokens_;
    std::vector<Comment> comments_;
    std::vector<CustomUniform> uniforms_;
    Names globals_;
    std::vector<CodeError>& errors_;
};

}  // namespace farfield
