#include "app/autosave.h"

#include "sdf/atomic_file.h"
#include "sdf/scene_file.h"
#include "sdf/user_folder.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <fstream>

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

namespace farfield {
namespace {

namespace fs = std::filesystem;

constexpr const char *lock_extension = ".lock", *copy_extension = ".work";
constexpr int version = 1;

fs::path lock_of(fs::path copy) { return copy.replace_extension(lock_extension); }

/// The lock, where nobody else has it; made where it is not there.
Descriptor take_lock(const fs::path& file) {
    Descriptor lock(::open(file.c_str(), O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW, 0600));
    if (!lock || ::flock(lock.get(), LOCK_EX | LOCK_NB) != 0) return {};
    struct stat named {};
    struct stat locked {};
    // Somebody may have removed it in between; then the lock protects nothing.
    const bool same = ::lstat(file.c_str(), &named) == 0 && ::fstat(lock.get(), &locked) == 0 &&
                      named.st_ino == locked.st_ino && named.st_dev == locked.st_dev;
    return same ? std::move(lock) : Descriptor();
}

/// In an order that a file keeps, though not the ids.
std::vector<Id> ordered_ids(const Scene& scene) {
    std::vector<Id> ids;
    visit_all_nodes(scene, [&](const Node& node) { ids.push_back(node.id); });
    return ids;
}

std::string text_of(const Scene& scene, const CodeDrafts& drafts, const fs::path& file) {
    using namespace std::chrono;
    nlohmann::ordered_json json;
    json["farfield_work"] = version;
    json["file"] = file.string();
    json["time"] = duration_cast<seconds>(system_clock::now().time_since_epoch()).count();
    json["nodes"] = count_nodes(scene) - 1;
    json["drafts"] = nlohmann::ordered_json::array();
    const std::vector<Id> ids = drafts.empty() ? std::vector<Id>() : ordered_ids(scene);
    for (std::size_t i = 0; i < ids.size(); ++i)
        if (const auto draft = drafts.find(ids[i]); draft != drafts.end())
            json["drafts"].push_back({{"node", i}, {"text", draft->second}});
    json["scene"] = to_text(scene);
    return json.dump(1, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
}

/// Throws where the file is not such a copy.
nlohmann::json read_copy(const fs::path& copy) {
    std::ifstream in(copy, std::ios::binary);
    nlohmann::json json = nlohmann::json::parse(in);
    if (json.at("farfield_work") != version) throw std::runtime_error("is of another version");
    return json;
}

/// Whether saving was the last that happened.
bool is_saved(const nlohmann::json& copy) {
    const std::string file = copy.at("file");
    if (file.empty() || !copy.at("drafts").empty()) return false;
    try {
        return read_scene_text(file) == copy.at("scene").get<std::string>();
    } catch (const SceneFileError&) {
        return false;
    }
}

void remove_copy(const fs::path& copy) {
    std::error_code ignored;
    fs::remove(copy, ignored);
    fs::remove(lock_of(copy), ignored);
}

}  // namespace

fs::path Autosave::user_folder() {
    const fs::path folder = farfield::user_folder("XDG_STATE_HOME", ".local/state");
    return folder.empty() ? folder : folder / "unsaved";
}

Autosave::Autosave(fs::path folder, double interval) : folder_(std::move(folder)), interval_(interval) {
    if (folder_.empty()) return;
    std::error_code failed;
    fs::create_directories(folder_, failed);
    for (int i = 0; i < 1000 && !lock_; ++i) {
        const fs::path copy = folder_ / fmt::format("{}-{}{}", ::getpid(), i, copy_extension);
        if (fs::exists(copy, failed)) continue;
        lock_file_ = lock_of(copy);
        own_ = copy;
        lock_ = take_lock(lock_file_);
        if (!lock_ && errno != EWOULDBLOCK && !fs::exists(lock_file_, failed)) break;
    }
    if (lock_)
        thread_ = std::thread([this] { run(); });
    else
        problem_ = fmt::format("{}: cannot be written", folder_.string());
}

Autosave::~Autosave() {
    if (!thread_.joinable()) return;
    {
        const std::lock_guard guard(mutex_);
        stop_ = true;
    }
    wake_.notify_one();
    thread_.join();
}

void Autosave::refresh(const Document& document, const CodeDrafts& drafts, double now) {
    if (!lock_) return;
    if (told_ != document.file()) {
        told_ = document.file();
        std::error_code ignored;
        const std::string text = told_->empty() ? "" : fs::absolute(*told_, ignored).lexically_normal().string();
        if (::ftruncate(lock_.get(), 0) != 0 || ::pwrite(lock_.get(), text.data(), text.size(), 0) < 0)
            told_.reset();  // again the next time
    }
    if (document.saved() && drafts.empty()) {
        if (std::exchange(keeps_, false)) hand_over({});
        next_ = now;
        return;
    }
    const std::pair state(document.revision(), drafts);
    if ((keeps_ && state == kept_) || now < next_) return;
    {
        const std::lock_guard guard(mutex_);
        if (busy_) return;
    }
    hand_over({std::make_shared<const Scene>(document.scene()), drafts, document.file()});
    kept_ = state;
    keeps_ = true;
    next_ = now + interval_;
}

void Autosave::hand_over(Copy copy) {
    {
        const std::lock_guard guard(mutex_);
        waiting_ = std::move(copy);
        busy_ = true;
    }
    wake_.notify_one();
}

void Autosave::wait_until_idle() {
    std::unique_lock guard(mutex_);
    idle_.wait(guard, [&] { return !busy_; });
}

void Autosave::run() {
    std::unique_lock guard(mutex_);
    for (;;) {
        wake_.wait(guard, [&] { return stop_ || waiting_; });
        if (!waiting_) return;
        const Copy copy = std::move(*std::exchange(waiting_, std::nullopt));
        guard.unlock();
        std::string problem;
        try {
            if (copy.scene)
                write_atomically(own_, text_of(*copy.scene, copy.drafts, copy.file));
            else
                fs::remove(own_);
        } catch (const std::exception& error) {
            problem = fmt::format("{}: {}", own_.parent_path().string(), error.what());
        }
        guard.lock();
        problem_ = problem;
        if (waiting_) continue;
        busy_ = false;
        idle_.notify_all();
    }
}

void Autosave::end() {
    if (!lock_) return;
    hand_over({});
    wait_until_idle();
    std::error_code ignored;
    fs::remove(lock_file_, ignored);
}

std::string Autosave::problem() const {
    const std::lock_guard guard(mutex_);
    return problem_;
}

std::vector<LeftWork> Autosave::left() const {
    std::vector<LeftWork> found;
    std::error_code failed;
    std::vector<fs::path> copies, locks;
    if (folder_.empty()) return found;
    for (fs::directory_iterator it(folder_, failed), end; !failed && it != end; it.increment(failed)) {
        if (it->path().extension() == copy_extension && it->path() != own_) copies.push_back(it->path());
        if (it->path().extension() == lock_extension && it->path() != lock_file_) locks.push_back(it->path());
    }
    for (const fs::path& copy : copies) {
        const Descriptor lock = take_lock(lock_of(copy));
        if (!lock) continue;
        try {
            const nlohmann::json json = read_copy(copy);
            if (is_saved(json))
                remove_copy(copy);
            else
                found.push_back({copy, json.at("file").get<std::string>(), json.at("time"), json.at("nodes")});
        } catch (const std::exception&) {  // no copy of ours: it stays
        }
    }
    for (const fs::path& file : locks)
        if (std::find(copies.begin(), copies.end(), fs::path(file).replace_extension(copy_extension)) == copies.end())
            if (const Descriptor lock = take_lock(file)) fs::remove(file, failed);
    std::sort(found.begin(), found.end(), [](const LeftWork& a, const LeftWork& b) { return a.time > b.time; });
    return found;
}

RecoveredWork Autosave::recover(const LeftWork& work) {
    const Descriptor lock = take_lock(lock_of(work.copy));
    if (!lock) throw FileError("another Farfield has recovered it");
    RecoveredWork recovered;
    try {
        const nlohmann::json json = read_copy(work.copy);
        recovered.file = json.at("file").get<std::string>();
        recovered.scene = parse_scene(json.at("scene").get<std::string>(), work.copy.string());
        const std::vector<Id> ids = ordered_ids(recovered.scene);
        for (const auto& draft : json.at("drafts"))
            recovered.drafts[ids.at(draft.at("node").get<std::size_t>())] = draft.at("text");
    } catch (const std::exception& error) {
        std::error_code ignored;
        if (!fs::exists(work.copy, ignored)) {
            fs::remove(lock_of(work.copy), ignored);
            throw FileError("another Farfield has recovered it");
        }
        throw FileError(fmt::format("{} cannot be read: {}", work.copy.string(), error.what()));
    }
    if (lock_) {
        wait_until_idle();
        std::error_code failed;
        fs::rename(work.copy, own_, failed);
        if (failed) throw FileError(fmt::format("{}: {}", work.copy.string(), failed.message()));
        keeps_ = true;
        kept_ = {};
        fs::remove(lock_of(work.copy), failed);
    }
    return recovered;
}

void Autosave::discard(const LeftWork& work) const {
    if (const Descriptor lock = take_lock(lock_of(work.copy))) remove_copy(work.copy);
}

bool Autosave::is_open_elsewhere(const fs::path& file) const {
    std::error_code failed;
    if (folder_.empty()) return false;
    for (fs::directory_iterator it(folder_, failed), end; !failed && it != end; it.increment(failed)) {
        if (it->path().extension() != lock_extension || it->path() == lock_file_) continue;
        std::string name(4097, '\0');
        const Descriptor lock(::open(it->path().c_str(), O_RDONLY | O_CLOEXEC | O_NOFOLLOW));
        const ssize_t length = lock ? ::pread(lock.get(), name.data(), name.size(), 0) : 0;
        if (length <= 0) continue;
        name.resize(static_cast<std::size_t>(length));
        std::error_code ignored;
        if (fs::equivalent(name, file, ignored) && ::flock(lock.get(), LOCK_SH | LOCK_NB) != 0) return true;
    }
    return false;
}

}  // namespace farfield
