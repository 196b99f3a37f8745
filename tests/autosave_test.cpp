// Copies of unsaved work: what they hold, when they are there, and that a program that is killed while it edits and
// saves loses seconds at most and leaves whole files.
#include "app/autosave.h"

#include "sdf/atomic_file.h"
#include "sdf/scene_file.h"
#include "tests/test_support.h"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <functional>
#include <thread>

#include <signal.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

namespace farfield {
namespace {

namespace fs = std::filesystem;

double seconds() { return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count(); }

std::size_t entries(const fs::path& folder) {
    return static_cast<std::size_t>(std::distance(fs::directory_iterator(folder), fs::directory_iterator()));
}

Edit named(const Scene& scene, const std::string& name) {
    return SetName{{ObjectType::node, scene.root.children.at(0).id}, name};
}

Id change(Document& document, const Edit& edit, unsigned gesture = 0) {
    return document.apply({edit}, gesture).front();
}

/// A document of one node, saved in `file`.
struct Work {
    explicit Work(const fs::path& file) {
        InsertNode insert{document.scene().root.id, 0, make_node(NodeKind::sphere)};
        change(document, insert, 0);
        document.save(file);
    }
    CodeTrust trust;
    Document document{trust};
};

/// Calls refresh until what it began is done.
void keep(Autosave& autosave, const Document& document, const CodeDrafts& drafts = {}) {
    static double now = 0.0;
    for (int i = 0; i < 3; ++i) {
        autosave.refresh(document, drafts, now += 100.0);
        std::this_thread::sleep_for(std::chrono::milliseconds(20));
    }
}

/// Does it in a child that ends without a word, as a crash does.
void crash_after(const std::function<void()>& work) {
    const pid_t child = ::fork();
    if (child == 0) {
        work();
        ::_exit(0);
    }
    int status = 0;
    ::waitpid(child, &status, 0);
    ASSERT_EQ(status, 0);
}

TEST(Autosave, UnsavedWorkIsRecoveredWithItsFileAndDrafts) {
    TemporaryFolder folder;
    const fs::path file = folder / "a.json", state = folder / "state";
    crash_after([&] {
        Work work(file);
        Document& document = work.document;
        Autosave autosave(state);
        keep(autosave, document);
        if (entries(state) != 1) ::_exit(1);  // the lock alone: what is saved needs no copy
        change(document, named(document.scene(), "mine"), 0);
        const Id custom = change(document, InsertNode{document.scene().root.id, 1, make_node(NodeKind::custom)}, 0);
        keep(autosave, document, {{custom, "float sdf(vec3 p) { return"}});
        if (!autosave.problem().empty()) ::_exit(2);
    });
    Autosave autosave(state);
    const std::vector<LeftWork> left = autosave.left();
    ASSERT_EQ(left.size(), 1u);
    EXPECT_EQ(left[0].file, file);
    EXPECT_EQ(left[0].nodes, 2);
    const RecoveredWork work = autosave.recover(left[0]);
    EXPECT_EQ(work.scene.root.children.at(0).name, "mine");
    EXPECT_EQ(work.file, file);
    ASSERT_EQ(work.drafts.size(), 1u);
    EXPECT_EQ(work.drafts.begin()->first, work.scene.root.children.at(1).id);
    EXPECT_EQ(work.drafts.begin()->second, "float sdf(vec3 p) { return");
    EXPECT_TRUE(autosave.left().empty()) << "it is this editor's own now";
    EXPECT_THROW(autosave.recover(left[0]), FileError);
    EXPECT_EQ(entries(state), 2u);

    CodeTrust trust;
    Document document(trust);
    document.recover(work.scene, work.file);
    EXPECT_FALSE(document.saved());
    document.save(work.file);
    keep(autosave, document);
    autosave.end();
    EXPECT_EQ(entries(state), 0u);
}

TEST(Autosave, ADocumentWithoutAFileIsRecoveredWithoutOne) {
    TemporaryFolder folder;
    crash_after([&] {
        CodeTrust trust;
        Document document(trust);
        change(document, InsertNode{document.scene().root.id, 0, make_node(NodeKind::sphere)}, 0);
        Autosave autosave(folder / "state");
        keep(autosave, document);
    });
    Autosave autosave(folder / "state");
    ASSERT_EQ(autosave.left().size(), 1u);
    EXPECT_EQ(autosave.left()[0].file, "");
    EXPECT_EQ(autosave.recover(autosave.left()[0]).scene.root.children.size(), 1u);
}

TEST(Autosave, ARecoveredCopyOutlivesAnotherCrash) {
    TemporaryFolder folder;
    const fs::path file = folder / "a.json", state = folder / "state";
    crash_after([&] {
        Work work(file);
        Autosave autosave(state);
        change(work.document, named(work.document.scene(), "mine"), 0);
        keep(autosave, work.document);
    });
    crash_after([&] {
        Autosave autosave(state);
        autosave.recover(autosave.left().at(0));
    });
    Autosave autosave(state);
    ASSERT_EQ(autosave.left().size(), 1u);
    EXPECT_EQ(autosave.recover(autosave.left()[0]).scene.root.children.at(0).name, "mine");
}

TEST(Autosave, SavedAndUndoneAndDiscardedWorkLeavesNothing) {
    TemporaryFolder folder;
    const fs::path file = folder / "a.json", state = folder / "state";
    crash_after([&] {
        Work work(file);
        Document& document = work.document;
        Autosave autosave(state);
        change(document, named(document.scene(), "mine"), 0);
        keep(autosave, document);
        if (entries(state) != 2) ::_exit(1);
        document.undo();
        keep(autosave, document);
        if (entries(state) != 1) ::_exit(2);
        document.redo();
        document.save(file);
        keep(autosave, document);
        if (entries(state) != 1) ::_exit(3);
        change(document, named(document.scene(), "other"), 0);
        keep(autosave, document);
    });
    Autosave autosave(state);
    ASSERT_EQ(autosave.left().size(), 1u);
    autosave.discard(autosave.left()[0]);
    EXPECT_TRUE(autosave.left().empty());
    autosave.end();
    EXPECT_EQ(entries(state), 0u);
}

TEST(Autosave, EditorsAtOnceLeaveEachOtherAlone) {
    TemporaryFolder folder;
    const fs::path file = folder / "a.json", state = folder / "state";
    Work first(file), second(folder / "b.json");
    Autosave one(state), two(state);
    change(first.document, named(first.document.scene(), "mine"), 0);
    keep(one, first.document);
    keep(two, second.document);
    EXPECT_TRUE(two.left().empty());
    EXPECT_TRUE(two.is_open_elsewhere(file));
    EXPECT_FALSE(one.is_open_elsewhere(file));
    EXPECT_TRUE(one.is_open_elsewhere(folder / "b.json"));
    two.end();
    EXPECT_FALSE(one.is_open_elsewhere(folder / "b.json"));
}

TEST(Autosave, WhatIsNoCopyStaysAndIsNotOffered) {
    TemporaryFolder folder;
    write_text(folder / "1-0.work", "{ not a copy");
    write_text(folder / "1-1.work", R"({"farfield_work": 99, "scene": ""})");
    Autosave autosave(folder / "");
    EXPECT_TRUE(autosave.left().empty());
    EXPECT_EQ(read_text(folder / "1-0.work"), "{ not a copy");
    autosave.end();
}

TEST(Autosave, AFolderThatCannotBeWrittenIsSaid) {
    TemporaryFolder folder;
    write_text(folder / "file", "");
    Autosave autosave(folder / "file");
    EXPECT_NE(autosave.problem(), "");
    autosave.end();
    Autosave nowhere{fs::path()};
    EXPECT_EQ(nowhere.problem(), "");
}

// ---- Kills

/// Written by the child, read after its death.
struct Log {
    static constexpr int most = 1 << 16;
    std::atomic<int> edits;             ///< done
    std::atomic<int> begun, completed;  ///< edits that the last saves to begin and to complete hold
    double time[most];                  ///< when each edit was done
};

/// The document says how many edits it has seen. One in `rarity` is followed by a save.
void edit_until_killed(const fs::path& file, const fs::path& state, double interval, unsigned rarity, unsigned seed,
                       Log& log) {
    std::mt19937 random(seed);
    CodeTrust trust;
    Document document(trust);
    document.open(random_scene(seed, 40), file);
    const Id light = change(document, AddLight{}, 0);
    Autosave autosave(state, interval);
    for (int i = 1; i < Log::most; ++i) {
        const glm::vec3 count{static_cast<float>(i), 0.0f, 0.0f};
        change(document, SetValue{{ObjectType::light, light}, "position", count}, static_cast<unsigned>(i / 10 + 1));
        log.time[i] = seconds();
        log.edits = i;
        if (random() % rarity == 0) {
            log.begun = i;
            document.save(file);
            log.completed = i;
        }
        autosave.refresh(document, {}, seconds());
        std::this_thread::sleep_for(std::chrono::microseconds(random() % 3000));
    }
}

int edits_in(const Scene& scene) { return static_cast<int>(scene.lights.back().position.x); }

/// How long a file may take to be written now, whatever else goes on on this machine.
class Disk {
public:
    ~Disk() {
        stop_ = true;
        thread_.join();
    }
    /// Seconds, of one that is not finished as well.
    double slowest() const { return std::max(slowest_.load(), seconds() - begun_); }

private:
    void write() {
        while (!stop_) {
            begun_ = seconds();
            write_atomically(folder_ / "file", "a file");
            slowest_ = slowest();
            std::this_thread::sleep_for(std::chrono::milliseconds(5));
        }
    }

    TemporaryFolder folder_;
    std::atomic<bool> stop_{false};
    std::atomic<double> begun_{seconds()}, slowest_{0.0};
    std::thread thread_{[this] { write(); }};
};

class Victim {
public:
    Victim(double interval, unsigned rarity, unsigned seed) : file_(folder_ / "scene.json"), state_(folder_ / "state") {
        log_ =
            static_cast<Log*>(::mmap(nullptr, sizeof(Log), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0));
        child_ = ::fork();
        if (child_ != 0) return;
        try {
            edit_until_killed(file_, state_, interval, rarity, seed, *log_);
        } catch (...) {
            ::_exit(1);
        }
        ::_exit(0);
    }
    ~Victim() { ::munmap(log_, sizeof(Log)); }
    Victim(const Victim&) = delete;
    Victim& operator=(const Victim&) = delete;

    /// Kills it and looks at what is left: nothing older than `bound` seconds is lost, or a little more where the disk
    /// is slow.
    void kill_and_check(double bound, const Disk& disk) {
        ASSERT_EQ(::kill(child_, SIGKILL), 0);
        const double death = seconds();
        int status = 0;
        ::waitpid(child_, &status, 0);
        ASSERT_TRUE(WIFSIGNALED(status)) << "it did not end by itself";

        int kept = 0;
        if (fs::exists(file_)) {
            const Scene saved = load_scene(file_);  // throws where it is not whole
            kept = edits_in(saved);
            EXPECT_EQ(to_text(saved), read_text(file_));
            EXPECT_TRUE(kept == log_->begun || kept == log_->completed)
                << "saved " << kept << " begun " << log_->begun << " completed " << log_->completed;
        }
        EXPECT_GE(kept, log_->completed);
        Autosave autosave(state_);
        const std::vector<LeftWork> left = autosave.left();
        EXPECT_LE(left.size(), 1u);
        if (!left.empty()) kept = std::max(kept, edits_in(autosave.recover(left[0]).scene));
        ASSERT_LE(kept, log_->edits + 1);  // killed between an edit and its note
        const int first_lost = kept + 1;
        if (first_lost <= log_->edits) {
            EXPECT_LE(death - log_->time[first_lost], bound + 2.0 * disk.slowest()) << kept << " " << log_->edits;
        }
        autosave.end();
        EXPECT_EQ(entries(state_), std::size_t(fs::exists(state_ / ".farfield-0.tmp")));
    }

private:
    TemporaryFolder folder_;
    fs::path file_, state_;
    Log* log_;
    pid_t child_;
};

/// Lets so many edit at once and kills them, one after the other, at random moments of that time.
void kill_many(int count, double from, double to, double interval, double bound, unsigned seed) {
    std::mt19937 random(seed);
    std::vector<double> moments;
    for (int i = 0; i < count; ++i) moments.push_back(std::uniform_real_distribution<double>(from, to)(random));
    std::sort(moments.begin(), moments.end());
    std::vector<std::unique_ptr<Victim>> victims;
    const double start = seconds();
    for (int i = 0; i < count; ++i) {
        // Some save all the time, most so seldom that it is the copies that matter.
        const unsigned rarity = i % 3 == 0 ? 8 : 10'000;
        victims.push_back(std::make_unique<Victim>(interval, rarity, seed + static_cast<unsigned>(i)));
    }
    const Disk disk;  // after the forks, which take no threads along
    for (int i = 0; i < count; ++i) {
        const double rest = start + moments[static_cast<std::size_t>(i)] - seconds();
        std::this_thread::sleep_for(std::chrono::duration<double>(std::max(0.0, rest)));
        victims[static_cast<std::size_t>(i)]->kill_and_check(bound, disk);
    }
}

TEST(Autosave, NinetyKillsAtAnyMomentLoseLittleAndBreakNoFile) {
    for (unsigned batch = 0; batch < 5; ++batch) kill_many(18, 0.0, 2.5, 0.2, 1.0, 100 * batch);
}

TEST(Autosave, TenKillsWithTheEditorsIntervalLoseFiveSecondsAtMost) { kill_many(10, 3.0, 9.0, 2.0, 5.0, 1000); }

}  // namespace
}  // namespace farfield
