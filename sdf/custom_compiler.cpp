#include "sdf/custom_compiler.h"

#include "sdf/custom_expressions.h"

#include <fmt/format.h>

#include <algorithm>

namespace farfield {
namespace custom {
namespace {

constexpr std::size_t deepest_call = 60;
constexpr double longest_unrolled = 32.0 * 26.0;  ///< as in Mesa's nir_opt_loop_unroll

/// Ends a function's compilation without a message of its own.
struct CallsBroken {};

/// The variables and the calls of a function.
class Contents : public TIntermTraverser {
public:
    void visitSymbol(TIntermSymbol* symbol) override { symbols.push_back(symbol); }
    bool visitAggregate(TVisit, TIntermAggregate* node) override {
        if (node->getOp() == EOpFunctionCall) calls.push_back(node);
        return true;
    }
    std::vector<TIntermSymbol*> symbols;
    std::vector<TIntermAggregate*> calls;
};

class Compiler : Expressions {
public:
    Compiler(const std::vector<CustomInput>& inputs, std::vector<CodeError>& errors)
        : Expressions(inputs), errors_(errors) {}

    CustomProgram compile(TIntermNode* root) {
        TIntermAggregate* all = root ? root->getAsAggregate() : nullptr;
        // A text of one function may come without the sequence around it.
        TIntermSequence alone(1, root);
        for (TIntermNode* node : all && all->getOp() != EOpFunction ? all->getSequence() : alone)
            if (TIntermAggregate* a = node ? node->getAsAggregate() : nullptr; a && a->getOp() == EOpFunction)
                functions_[a->getName().c_str()].node = a;
        for (auto& [name, f] : functions_) attempt(f);
        if (!errors_.empty()) return {};
        const auto entry = functions_.find("sdf(vf3;");
        if (entry == functions_.end() || entry->second.result.base != EbtFloat || entry->second.result.cells != 1) {
            errors_.push_back({1, "there is no float sdf(vec3 p)"});
            return {};
        }
        check_entry(entry->second);
        std::reverse(program_.constants.begin(), program_.constants.end());
        return std::move(program_);
    }

private:
    void attempt(Function& f) {
        try {
            function(f);
        } catch (const Refused& refused) {
            f.state = Function::broken;
            errors_.push_back({refused.line, refused.what()});
        } catch (const CallsBroken&) {
            f.state = Function::broken;
        }
    }

    void check_entry(const Function& f) {
        const int line = line_of(f.node);
        program_.entry = f.start;
        program_.point = f.parameters[0].at;
        program_.result = f.result.at;
        program_.repetitions = static_cast<std::uint64_t>(std::min(f.repetitions, most_repetitions));
        TIntermNode* point = f.node->getSequence()[0]->getAsAggregate()->getSequence()[0];
        const TStorageQualifier storage = point->getAsTyped()->getQualifier().storage;
        if (storage == EvqOut || storage == EvqInOut)
            errors_.push_back({line, "the parameter of sdf must not be out or inout"});
        if (f.repetitions > most_repetitions)
            errors_.push_back({line, fmt::format("one evaluation takes up to {:.0f} steps of loops, at most {:.0f} are "
                                                 "allowed",
                                                 f.repetitions, most_repetitions)});
        else if (f.operations > most_operations)
            errors_.push_back({line, fmt::format("one evaluation takes up to {:.0f} operations, at most {:.0f} are "
                                                 "allowed",
                                                 f.operations, most_operations)});
        else if (f.inlined > longest_inlined)
            errors_.push_back({line, fmt::format("with calls inlined and short loops unrolled the code has {:.0f} "
                                                 "operations, at most {:.0f} are allowed",
                                                 f.inlined, longest_inlined)});
    }

    // ---- functions -------------------------------------------------------------------------------------------------

    void function(Function& f) {
        if (f.state != Function::unknown) return;
        f.state = Function::open;
        breaks_.clear(), continues_.clear();
        Contents contents;
        f.node->traverse(&contents);
        for (TIntermAggregate* call : contents.calls) {
            Function& callee = called(call);
            if (callee.state == Function::open)
                refuse(line_of(call), "a function must not call itself, directly or through others");
            attempt(callee);
            if (callee.state == Function::broken) throw CallsBroken();
            f.depth = std::max(f.depth, callee.depth + 1);
        }
        if (f.depth > deepest_call)
            refuse(line_of(f.node), fmt::format("more than {} calls inside one another", deepest_call));
        for (TIntermSymbol* symbol : contents.symbols)
            if (!symbol->getName().empty()) variable(symbol);
        for (TIntermNode* node : f.node->getSequence())
            if (TIntermAggregate* part = node ? node->getAsAggregate() : nullptr;
                part && part->getOp() == EOpParameters)
                for (TIntermNode* p : part->getSequence()) f.parameters.push_back(variable(p->getAsSymbolNode()));
        f.result = {allocate(f.node->getType(), line_of(f.node)), 0, f.node->getBasicType()};
        f.result.cells = program_.cells - f.result.at;
        if (f.node->getBasicType() == EbtVoid) f.result.cells = 0;

        current_ = &f;
        first_temporary_ = next_temporary_ = program_.cells;
        factor_ = 1.0;
        f.start = static_cast<int>(program_.instructions.size());
        for (TIntermNode* node : f.node->getSequence()) {
            TIntermAggregate* part = node ? node->getAsAggregate() : nullptr;
            if (!part || part->getOp() != EOpParameters) statement(node);
        }
        emit({.operation = O::return_});
        f.state = Function::done;
    }

    // ---- statements ------------------------------------------------------------------------------------------------

    void statement(TIntermNode* node) {
        if (!node) return;
        statement_line_ = std::max(1, line_of(node));
        const int free = next_temporary_;
        if (TIntermSelection* selection = node->getAsSelectionNode(); selection && selection->getBasicType() == EbtVoid)
            choice(selection);
        else if (TIntermSwitch* cases = node->getAsSwitchNode())
            switch_statement(cases);
        else if (TIntermBranch* branch = node->getAsBranchNode())
            branch_statement(branch);
        else if (node->getAsLoopNode())
            loop(node->getAsLoopNode(), nullptr);
        else if (TIntermAggregate* a = node->getAsAggregate();
                 a && (a->getOp() == EOpSequence || a->getOp() == EOpScope))
            sequence(a);
        else if (TIntermTyped* typed = node->getAsTyped())
            expression(typed);
        else
            unsupported(node);
        next_temporary_ = free;
    }

    void sequence(TIntermAggregate* node) {
        TIntermNode* before = nullptr;
        for (TIntermNode* child : node->getSequence()) {
            if (child && child->getAsLoopNode())
                loop(child->getAsLoopNode(), before);
            else
                statement(child);
            before = child;
        }
    }

    void choice(TIntermSelection* node) {
        const std::size_t to_else = emit({.operation = O::jump_if_false, .a = expression(node->getCondition()).at});
        statement(node->getTrueBlock());
        if (!node->getFalseBlock()) return land({to_else});
        const std::size_t to_end = emit({.operation = O::jump});
        land({to_else});
        statement(node->getFalseBlock());
        land({to_end});
    }

    void loop(TIntermLoop* node, TIntermNode* before) {
        if (!node->testFirst() || !node->getTest() || !node->getTerminal())
            refuse(line_of(node), "expected a loop as for (int i = 0; i < 8; ++i)");
        const LoopSteps steps = ranges_.steps(node, before, most_repetitions);
        const double outside = factor_;
        factor_ *= steps.count + 1.0;
        const double inlined = current_->inlined;
        const int free = next_temporary_, start = here();
        const std::size_t leave = emit({.operation = O::jump_if_false, .a = expression(node->getTest()).at});
        next_temporary_ = free;
        factor_ = outside * steps.count;
        current_->repetitions += factor_;
        breaks_.emplace_back(), continues_.emplace_back();
        ranges_.enter(steps);
        statement(node->getBody());
        ranges_.leave(steps);
        land(continues_.back());
        expression(node->getTerminal());
        next_temporary_ = free;
        emit({.operation = O::repeat, .c = start});
        land({leave});
        land(breaks_.back());
        breaks_.pop_back(), continues_.pop_back();
        factor_ = outside;
        if (const double body = current_->inlined - inlined;
            steps.count <= 32.0 && steps.count * body <= longest_unrolled)
            current_->inlined = inlined + std::max(steps.count, 1.0) * body;
    }

    void switch_statement(TIntermSwitch* node) {
        const Value selector = copy(expression(node->getCondition()->getAsTyped()));
        const TIntermSequence& body = node->getBody()->getSequence();
        std::map<TIntermNode*, std::size_t> jumps;
        std::size_t otherwise = 0;
        bool has_default = false;
        for (TIntermNode* child : body)
            if (TIntermBranch* b = child->getAsBranchNode(); b && b->getFlowOp() == EOpCase)
                jumps[child] =
                    emit({.operation = O::jump_if_equal, .a = selector.at, .b = expression(b->getExpression()).at});
        otherwise = emit({.operation = O::jump});
        breaks_.emplace_back();
        for (TIntermNode* child : body) {
            TIntermBranch* b = child->getAsBranchNode();
            if (b && b->getFlowOp() == EOpCase)
                land({jumps[child]});
            else if (b && b->getFlowOp() == EOpDefault)
                land({otherwise}), has_default = true;
            else
                statement(child);
        }
        if (!has_default) land({otherwise});
        land(breaks_.back());
        breaks_.pop_back();
    }

    void branch_statement(TIntermBranch* node) {
        switch (node->getFlowOp()) {
            case EOpReturn:
                if (node->getExpression())
                    move(current_->result.at, expression(node->getExpression()).at, current_->result.cells);
                emit({.operation = O::return_});
                break;
            case EOpBreak:
                breaks_.back().push_back(emit({.operation = O::jump}));
                break;
            case EOpContinue:
                continues_.back().push_back(emit({.operation = O::jump}));
                break;
            default:
                unsupported(node);
        }
    }

    std::vector<CodeError>& errors_;
    std::vector<Labels> breaks_, continues_;
};

}  // namespace
}  // namespace custom

CustomProgram compile_custom(TIntermNode* root, const std::vector<CustomInput>& inputs,
                             std::vector<CodeError>& errors) {
    return custom::Compiler(inputs, errors).compile(root);
}

}  // namespace farfield
