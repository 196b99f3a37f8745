// A document whose file is written, removed and brought back by other programs.
#include "app/document.h"
#include "app/file_watch.h"
#include "sdf/matching_ids.h"
#include "sdf/scene_file.h"
#include "tests/test_support.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace farfield {
namespace {

namespace fs = std::filesystem;
using News = FileWatch::News;

Id change(Document& document, const Edit& edit, unsigned gesture = 0) {
    return document.apply({edit}, gesture).front();
}

/// All news of some seconds.
std::vector<News> look(FileWatch& watch, double& now) {
    std::vector<News> news;
    for (int i = 0; i < 20; ++i)
        if (const News n = watch.look(now += 0.2); n != News::none) news.push_back(n);
    return news;
}

TEST(FileWatch, TellsWhatOtherProgramsDoOnce) {
    TemporaryFolder folder;
    const fs::path file = folder / "a.json", other = folder / "b.json";
    double now = 0.0;
    FileWatch watch;
    EXPECT_EQ(look(watch, now), std::vector<News>());
    write_text(file, "one");
    watch.follow(file, "one");
    EXPECT_EQ(look(watch, now), std::vector<News>());
    write_text(file, "two");
    EXPECT_TRUE(watch.is_other_now());
    EXPECT_EQ(look(watch, now), std::vector{News::changed});
    EXPECT_FALSE(watch.is_other_now());
    write_text(file, "two");  // written, not changed
    EXPECT_EQ(look(watch, now), std::vector<News>());
    write_text(other, "six");  // replaced by a file of the same size
    fs::rename(other, file);
    EXPECT_EQ(look(watch, now), std::vector{News::changed});
    fs::remove(file);
    EXPECT_EQ(look(watch, now), std::vector{News::gone});
    write_text(file, "six");
    EXPECT_EQ(look(watch, now), std::vector{News::back});
    fs::remove(file);
    EXPECT_EQ(look(watch, now), std::vector{News::gone});
    write_text(file, "ten");
    EXPECT_EQ(look(watch, now), std::vector{News::changed});
    watch.follow(file, "else");  // what is there is not what was read
    EXPECT_EQ(look(watch, now), std::vector{News::changed});
}

TEST(FileWatch, WaitsForAFileThatIsBeingWritten) {
    TemporaryFolder folder;
    const fs::path file = folder / "a.json";
    write_text(file, "one");
    FileWatch watch;
    watch.follow(file, "one");
    double now = 0.0;
    std::string text;
    for (int i = 0; i < 40; ++i) {
        write_text(file, text += "x");
        EXPECT_EQ(watch.look(now += 0.3), News::none);
    }
    EXPECT_EQ(look(watch, now), std::vector{News::changed});
    for (int i = 0; i < 10; ++i) {  // removed and written again, as some editors do
        fs::remove(file);
        EXPECT_EQ(watch.look(now += 0.3), News::none);
        write_text(file, text);
        EXPECT_EQ(watch.look(now += 0.3), News::none);
    }
}

TEST(MatchingIds, ASceneThatWasReadAgainIsTheSame) {
    for (unsigned seed = 0; seed < 20; ++seed) {
        const Scene scene = random_scene(seed, 60);
        const Scene read = with_ids_of(parse_scene(to_text(scene), "text"), scene);
        EXPECT_EQ(to_text(read), to_text(scene));
        EXPECT_EQ(all_ids(read), all_ids(scene)) << seed;
        for (std::size_t i = 0; i < scene.materials.size(); ++i) EXPECT_EQ(read.materials[i].id, scene.materials[i].id);
        for (std::size_t i = 0; i < scene.lights.size(); ++i) EXPECT_EQ(read.lights[i].id, scene.lights[i].id);
        EXPECT_EQ(read.bookmarks, scene.bookmarks);
    }
}

TEST(MatchingIds, ObjectsKeepTheirIdsAmongOthersAndIdsAreUnique) {
    for (unsigned seed = 0; seed < 40; ++seed) {
        const Scene old = random_scene(seed, 40);
        std::mt19937 random(seed);
        Scene edited = parse_scene(to_text(old), "text");
        for (int i = 0; i < 30; ++i) {
            try {
                farfield::apply(edited, random_edit(edited, random));
            } catch (const EditError&) {}
        }
        const Scene matched = with_ids_of(edited, old);
        EXPECT_EQ(to_text(matched), to_text(edited));
        std::vector<Id> ids = all_ids(matched);
        for (const Material& m : matched.materials) ids.push_back(m.id);
        for (const Light& l : matched.lights) ids.push_back(l.id);
        for (const Bookmark& b : matched.bookmarks) ids.push_back(b.id);
        const std::size_t count = ids.size();
        std::sort(ids.begin(), ids.end());
        EXPECT_EQ(std::unique(ids.begin(), ids.end()) - ids.begin(), static_cast<std::ptrdiff_t>(count));
        EXPECT_LT(ids.back(), matched.next_id);
        EXPECT_GT(ids.front(), 0u);
        for (const Material& m : matched.materials)
            for (const Material& o : old.materials) {
                if (m.name == o.name) {
                    EXPECT_EQ(m.id, o.id);
                }
            }
    }
}

TEST(Document, AReloadIsOneStepAndTheCameraStaysUnlessTheFileMovesIt) {
    CodeTrust trust;
    Document document(trust);
    TemporaryFolder folder;
    const fs::path file = folder / "a.json";
    document.reset(random_scene(3));
    document.save(file);
    const std::string first = to_text(document.scene());
    const Id root = document.scene().root.id;

    Scene theirs = parse_scene(first, "text");
    theirs.lights.push_back({});
    theirs.lights.back().name = "theirs";
    theirs.lights.back().id = theirs.new_id();
    EXPECT_TRUE(document.saved_but_for_camera());
    document.reload(theirs);
    EXPECT_TRUE(document.saved());
    EXPECT_EQ(document.scene().root.id, root);
    EXPECT_EQ(to_text(document.scene()), to_text(theirs));
    EXPECT_EQ(document.history().steps(), std::vector<std::string>{"reload a.json"});
    document.undo();
    EXPECT_EQ(to_text(document.scene()), first);
    EXPECT_FALSE(document.saved());
    document.redo();
    EXPECT_TRUE(document.saved());

    const glm::vec3 mine{1.0f, 2.0f, 3.0f};
    change(document, SetValue{{ObjectType::camera, 0}, "position", mine}, 0);
    EXPECT_FALSE(document.saved());
    EXPECT_TRUE(document.saved_but_for_camera());
    theirs.lights.pop_back();
    document.reload(theirs);
    EXPECT_EQ(document.scene().camera.position, mine);
    EXPECT_FALSE(document.saved());
    EXPECT_TRUE(document.saved_but_for_camera());
    theirs.camera.position = {4.0f, 5.0f, 6.0f};
    document.reload(theirs);
    EXPECT_EQ(document.scene().camera.position, theirs.camera.position);
    EXPECT_TRUE(document.saved());

    change(document, SetValue{{ObjectType::settings, 0}, "exposure", glm::vec3(1.0f)}, 0);
    EXPECT_FALSE(document.saved_but_for_camera());
    document.undo();
    document.set_file_lost(true);
    EXPECT_FALSE(document.saved());
    document.set_file_lost(false);
    EXPECT_TRUE(document.saved());
}

}  // namespace
}  // namespace farfield
