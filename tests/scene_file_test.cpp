// Scene files: round trips and safe saving. What is refused is tested in scene_error_test and scene_fuzz_test.
#include "sdf/scene_file.h"

#include "sdf/fields.h"
#include "tests/test_support.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <functional>
#include <limits>
#include <map>
#include <thread>

#include <sched.h>
#include <signal.h>
#include <sys/mount.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

namespace farfield {
namespace {

namespace fs = std::filesystem;

TEST(SceneFile, IdsAreUniqueAndNotZero) {
    const Scene scene = parse_scene(to_text(random_scene(1, 50)), "a.json");
    std::vector<Id> ids = all_ids(scene);
    for (const Material& material : scene.materials) ids.push_back(material.id);
    for (const Light& light : scene.lights) ids.push_back(light.id);
    for (const Bookmark& bookmark : scene.bookmarks) ids.push_back(bookmark.id);
    std::sort(ids.begin(), ids.end());
    EXPECT_EQ(std::adjacent_find(ids.begin(), ids.end()), ids.end());
    EXPECT_GT(ids.front(), 0u);
    EXPECT_LT(ids.back(), scene.next_id);
}

TEST(SceneFile, BundledScenesAreFixedPoints) {
    ASSERT_GE(bundled_scenes().size(), 6u);
    for (const fs::path& file : bundled_scenes()) {
        SCOPED_TRACE(file);
        EXPECT_EQ(to_text(load_scene(file)), read_text(file));
    }
}

TEST(SceneFile, RandomScenesSurviveSavingAndLoading) {
    const std::function<void(const Node&, std::map<NodeKind, int>&)> count = [&](const Node& node, auto& counts) {
        ++counts[node.kind];
        for (const Node& child : node.children) count(child, counts);
    };
    std::map<NodeKind, int> kinds;
    for (unsigned seed = 0; seed < 200; ++seed) {
        const Scene scene = random_scene(seed, 1 + static_cast<int>(seed % 60));
        count(scene.root, kinds);
        const std::string text = to_text(scene);
        const Scene again = parse_scene(text, "a.json");
        ASSERT_EQ(to_text(again), text) << "seed " << seed;
        ASSERT_EQ(count_nodes(again), count_nodes(scene)) << "seed " << seed;
    }
    for (const KindInfo& kind : node_kinds()) EXPECT_GE(kinds[kind.kind], 20) << kind.key << " occurs too rarely";
}

/// Every value, that is: the tables' own view of both scenes agrees bit for bit.
TEST(SceneFile, EveryValueSurvivesSavingAndLoading) {
    for (unsigned seed = 0; seed < 200; ++seed) {
        const Scene before = random_scene(seed, 30);
        const Scene after = parse_scene(to_text(before), "a.json");
        auto compare = [&](ObjectRef a, ObjectRef b) {
            const auto list = parameters(before, a);
            ASSERT_EQ(list.size(), parameters(after, b).size());
            for (const Parameter& parameter : list)
                for (int i = 0; i < parameter.components(); ++i)
                    ASSERT_EQ(value(before, a, parameter.key)[i], value(after, b, parameter.key)[i])
                        << seed << parameter.key;
        };
        auto compare_nodes = [&](auto& self, const Node& a, const Node& b) -> void {
            ASSERT_EQ(a.kind, b.kind);
            ASSERT_EQ(a.name, b.name);
            const Node *shown = find_definition(before, a.definition),
                       *shown_after = find_definition(after, b.definition);
            ASSERT_EQ(shown ? shown->name : "", shown_after ? shown_after->name : "");
            ASSERT_EQ(material_index(before, a.material, 99), material_index(after, b.material, 99));
            compare({ObjectType::node, a.id}, {ObjectType::node, b.id});
            ASSERT_EQ(a.children.size(), b.children.size());
            for (size_t i = 0; i < a.children.size(); ++i) self(self, a.children[i], b.children[i]);
        };
        compare_nodes(compare_nodes, before.root, after.root);
        ASSERT_EQ(before.definitions.size(), after.definitions.size());
        for (size_t i = 0; i < before.definitions.size(); ++i)
            compare_nodes(compare_nodes, before.definitions[i], after.definitions[i]);
        ASSERT_EQ(before.materials.size(), after.materials.size());
        for (size_t i = 0; i < before.materials.size(); ++i)
            compare({ObjectType::material, before.materials[i].id}, {ObjectType::material, after.materials[i].id});
        ASSERT_EQ(before.lights.size(), after.lights.size());
        for (size_t i = 0; i < before.lights.size(); ++i)
            compare({ObjectType::light, before.lights[i].id}, {ObjectType::light, after.lights[i].id});
        ASSERT_EQ(before.bookmarks.size(), after.bookmarks.size());
        for (size_t i = 0; i < before.bookmarks.size(); ++i) {
            compare({ObjectType::bookmark, before.bookmarks[i].id}, {ObjectType::bookmark, after.bookmarks[i].id});
            EXPECT_EQ(before.bookmarks[i].name, after.bookmarks[i].name);
        }
        for (ObjectType type : {ObjectType::sky, ObjectType::camera, ObjectType::settings})
            compare({type, 0}, {type, 0});
    }
}

/// One node of each kind with no parameter at its default, as random values may be: so no key is left out, and each
/// comes back under its own.
TEST(SceneFile, EveryParameterOfEveryKindSurvivesSavingAndLoading) {
    std::mt19937 random(8);
    for (const KindInfo& kind : node_kinds()) {
        if (kind.role == Role::instance) continue;  // of what? See instances_test
        Scene scene;
        const Id id = apply(scene, InsertNode{scene.root.id, -1, make_node(kind.kind)});
        const ObjectRef node{ObjectType::node, id};
        for (const Parameter& parameter : parameters(scene, node)) {
            glm::vec3 v = parameter.initial;
            for (int i = 0; i < 100 && v == parameter.initial; ++i) v = random_value(parameter, random);
            ASSERT_NE(v, parameter.initial) << kind.key << " " << parameter.key;
            set_value(scene, node, parameter.key, v);
        }
        const std::string text = to_text(scene);
        const Scene again = parse_scene(text, "a.json");
        EXPECT_EQ(to_text(again), text);
        const Node& before = scene.root.children.at(0);
        const Node& after = again.root.children.at(0);
        EXPECT_EQ(after.kind, kind.kind);
        EXPECT_EQ(after.values, before.values) << kind.key;
        for (const Parameter& parameter : kind.parameters)
            EXPECT_NE(text.find(fmt::format("\"{}\": ", parameter.key)), std::string::npos) << kind.key;
    }
}

TEST(SceneFile, FloatsAreWrittenShortAndExactly) {
    Scene scene;
    for (float x :
         {0.1f, 1.0f / 3.0f, 123456.789f, 1e-20f, 999999.94f, -0.0f, std::numeric_limits<float>::denorm_min()}) {
        scene.camera.position.x = x;
        EXPECT_EQ(parse_scene(to_text(scene), "a.json").camera.position.x, x);
    }
    scene.camera.position = {0.1f, -0.0f, 1000.0f};
    EXPECT_NE(to_text(scene).find("\"position\": [0.1, 0, 1000]"), std::string::npos) << to_text(scene);
}

TEST(SceneFile, DefaultsAreOmitted) {
    EXPECT_EQ(to_text(Scene()), R"({
  "farfield": 1,
  "materials": {
    "default": {}
  },
  "root": {
    "kind": "union",
    "name": "scene"
  }
}
)");
}

TEST(SceneFile, AnEditOfOneNumberIsADifferenceOfOneLine) {
    auto lines = [](const std::string& text) {
        std::vector<std::string> list{""};
        for (char c : text) c == '\n' ? list.emplace_back() : list.back() += c, void();
        return list;
    };
    int compared = 0;
    for (unsigned seed = 0; seed < 50; ++seed) {
        Scene scene = random_scene(seed, 20);
        std::mt19937 random(seed);
        for (Id id = 1; id < scene.next_id; ++id) {
            const ObjectRef object{ObjectType::node, id};
            for (const Parameter& parameter : parameters(scene, object)) {
                // Two values that are not the default, so that the line is there before and after.
                auto other_value = [&](glm::vec3 taken) {
                    for (int i = 0; i < 100; ++i)
                        if (glm::vec3 v = random_value(parameter, random); v != parameter.initial && v != taken)
                            return v;
                    return taken;
                };
                const glm::vec3 first = other_value(parameter.initial), second = other_value(first);
                if (first == second) continue;
                set_value(scene, object, parameter.key, first);
                const auto before = lines(to_text(scene));
                set_value(scene, object, parameter.key, second);
                const auto after = lines(to_text(scene));
                ASSERT_EQ(before.size(), after.size());
                int different = 0;
                for (size_t i = 0; i < before.size(); ++i) different += before[i] != after[i];
                ASSERT_EQ(different, 1) << parameter.key;
                ++compared;
            }
        }
    }
    EXPECT_GT(compared, 1000);
}

TEST(SceneFile, KeysMayComeInAnyOrder) {
    const Scene scene =
        parse_scene(R"({"root": {"material": "m", "kind": "union"}, "materials": {"m": {}}, "farfield": 1})", "a");
    EXPECT_EQ(scene.root.material, scene.materials.front().id);
}

TEST(SceneFile, NamesMayHoldAnyPrintableText) {
    Scene scene;
    for (const char* name : {"a\"b\\c", "tête-à-tête", "*/ // {}", " ", "光"}) {
        scene.root.name = scene.materials.front().name = name;
        const Scene again = parse_scene(to_text(scene), "a.json");
        EXPECT_EQ(again.root.name, name);
        EXPECT_EQ(again.materials.front().name, name);
    }
}

// ---- files on disk
// ---------------------------------------------------------------------------------------------------

std::string load_problem(const fs::path& file) {
    try {
        load_scene(file);
    } catch (const SceneFileError& error) {
        EXPECT_EQ(error.file, file.string());
        EXPECT_EQ(error.line, 0);
        return error.problem;
    }
    return "";
}

std::string save_problem(const Scene& scene, const fs::path& file) {
    try {
        save_scene(scene, file);
    } catch (const SceneFileError& error) {
        return error.problem;
    }
    return "";
}

size_t entries(const fs::path& folder) {
    return static_cast<size_t>(std::distance(fs::directory_iterator(folder), fs::directory_iterator()));
}

TEST(SceneFileOnDisk, WhatCannotBeReadIsAnError) {
    TemporaryFolder folder;
    EXPECT_EQ(load_problem(folder / "nothing.json"), "cannot be opened: No such file or directory");
    EXPECT_EQ(load_problem(folder / ""), "is a folder, expected a scene file");
    EXPECT_EQ(load_problem("/dev/zero"), "is too large, expected at most 8 MB");
    fs::path large = folder / "large.json";
    write_text(large, "");
    fs::resize_file(large, 100'000'000);
    EXPECT_EQ(load_problem(large), "is too large, expected at most 8 MB");
}

TEST(SceneFileOnDisk, SavedScenesLoad) {
    TemporaryFolder folder;
    const fs::path file = folder / "a.json";
    const Scene scene = random_scene(7);
    save_scene(scene, file);
    EXPECT_EQ(read_text(file), to_text(scene));
    save_scene(load_scene(file), file);
    EXPECT_EQ(read_text(file), to_text(scene));
    EXPECT_EQ(entries(folder / ""), 1u);
}

TEST(SceneFileOnDisk, PermissionsAreKept) {
    TemporaryFolder folder;
    const fs::path file = folder / "a.json";
    write_text(file, "old");
    ASSERT_EQ(::chmod(file.c_str(), 0640), 0);
    save_scene(Scene(), file);
    struct stat status {};
    ASSERT_EQ(::stat(file.c_str(), &status), 0);
    EXPECT_EQ(status.st_mode & 07777, 0640u);
    EXPECT_EQ(read_text(file), to_text(Scene()));
}

TEST(SceneFileOnDisk, SymbolicLinksAreKept) {
    TemporaryFolder folder;
    fs::create_directory(folder / "real");
    fs::create_symlink("real/a.json", folder / "link.json");
    fs::create_symlink("link.json", folder / "link2.json");
    save_scene(Scene(), folder / "link2.json");  // its end does not exist yet
    save_scene(random_scene(1), folder / "link2.json");
    EXPECT_TRUE(fs::is_symlink(folder / "link.json"));
    EXPECT_TRUE(fs::is_symlink(folder / "link2.json"));
    EXPECT_EQ(read_text(folder / "real/a.json"), to_text(random_scene(1)));
}

TEST(SceneFileOnDisk, TheOldFileSurvivesFailures) {
    TemporaryFolder folder;
    const fs::path file = folder / "a.json";
    write_text(file, "old");
    Scene broken;
    broken.camera.field_of_view = std::numeric_limits<float>::quiet_NaN();
    EXPECT_NE(save_problem(broken, file), "");
    EXPECT_EQ(read_text(file), "old");

    EXPECT_EQ(save_problem(Scene(), folder / ""), "is not a regular file, expected a file to replace");
    EXPECT_EQ(save_problem(Scene(), folder / "no/such/folder.json"), "cannot be written: No such file or directory");
    EXPECT_EQ(save_problem(Scene(), file / "inside.json"), "cannot be written: Not a directory");
    EXPECT_EQ(entries(folder / ""), 1u);
}

TEST(SceneFileOnDisk, ReadOnlyFolderAndFile) {
    // In a child that is not root: root may write anywhere.
    TemporaryFolder folder;
    const fs::path file = folder / "a.json";
    write_text(file, "old");
    fs::permissions(folder / "", fs::perms(0555));
    const auto problem_is = [&](const char* expected) {
        if (::geteuid() == 0 && ::setuid(65534) != 0) ::_exit(2);
        ::_exit(save_problem(Scene(), file) == expected ? 0 : 1);
    };
    EXPECT_EXIT(problem_is("cannot be written: Permission denied"), testing::ExitedWithCode(0), "");
    fs::permissions(file, fs::perms(0666));
    EXPECT_EXIT(problem_is("its folder cannot be written to: Permission denied"), testing::ExitedWithCode(0), "");
    fs::permissions(folder / "", fs::perms::owner_all);
    EXPECT_EQ(read_text(file), "old");
    EXPECT_EQ(entries(folder / ""), 1u);
}

/// Runs `test` in a child with a disk of `size` at `folder`; its status, or 77 where the system lets us mount nothing.
int on_small_disk(const fs::path& folder, const char* size, const std::function<bool()>& test) {
    const pid_t child = ::fork();
    if (child == 0) {
        const bool mounted = (::unshare(CLONE_NEWNS) == 0 || ::unshare(CLONE_NEWUSER | CLONE_NEWNS) == 0) &&
                             ::mount("none", "/", nullptr, MS_REC | MS_PRIVATE, nullptr) == 0 &&
                             ::mount("none", folder.c_str(), "tmpfs", 0, size) == 0;
        ::_exit(!mounted ? 77 : test() ? 0 : 1);
    }
    int status = 0;
    ::waitpid(child, &status, 0);
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

TEST(SceneFileOnDisk, AFullDiskLeavesTheOldFile) {
    TemporaryFolder folder;
    const fs::path file = folder / "a.json";
    const int status = on_small_disk(folder / "", "size=64k", [&] {
        save_scene(random_scene(1), file);
        const std::string old = to_text(random_scene(1));
        // Nothing left: a file fills the disk.
        std::ofstream(folder / "filler") << std::string(100'000, 'x');
        const std::string problem = save_problem(random_scene(2, 100), file);
        const bool whole = read_text(file) == old && entries(folder / "") == 2;
        fs::remove(folder / "filler");
        save_scene(random_scene(2), file);
        return problem == "cannot be written: No space left on device" && whole &&
               read_text(file) == to_text(random_scene(2));
    });
    if (status == 77) GTEST_SKIP() << "nothing can be mounted here";
    EXPECT_EQ(status, 0);
}

TEST(SceneFileOnDisk, AFileTooLargeForTheSystemLeavesTheOldFile) {
    // Writing fails in the middle. In a child, as the limit stays.
    TemporaryFolder folder;
    const fs::path file = folder / "a.json";
    write_text(file, "old");
    EXPECT_EXIT(
        {
            ::signal(SIGXFSZ, SIG_IGN);
            rlimit limit;
            limit.rlim_cur = limit.rlim_max = 100;
            ::setrlimit(RLIMIT_FSIZE, &limit);
            ::_exit(save_problem(Scene(), file) == "cannot be written: File too large" ? 0 : 1);
        },
        testing::ExitedWithCode(0), "");
    EXPECT_EQ(read_text(file), "old");
    EXPECT_EQ(entries(folder / ""), 1u);
}

TEST(SceneFileOnDisk, WhatAKilledProgramLeftIsUsedAgain) {
    TemporaryFolder folder;
    const fs::path file = folder / "a.json";
    write_text(folder / ".farfield-0.tmp", std::string(100'000, 'x'));
    save_scene(Scene(), file);
    EXPECT_EQ(read_text(file), to_text(Scene()));
    EXPECT_EQ(entries(folder / ""), 1u);
}

TEST(SceneFileOnDisk, SavingAtOnceLeavesOneOfTheScenes) {
    TemporaryFolder folder;
    const fs::path file = folder / "a.json";
    std::vector<std::thread> threads;
    for (unsigned seed = 0; seed < 4; ++seed)
        threads.emplace_back([&, scene = random_scene(seed)] {
            for (int i = 0; i < 20; ++i) save_scene(scene, file);
        });
    for (std::thread& thread : threads) thread.join();
    const std::string text = read_text(file);
    EXPECT_TRUE(text == to_text(random_scene(0)) || text == to_text(random_scene(1)) ||
                text == to_text(random_scene(2)) || text == to_text(random_scene(3)));
    EXPECT_EQ(entries(folder / ""), 1u);
}

}  // namespace
}  // namespace farfield
