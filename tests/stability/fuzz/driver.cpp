// Runs a libFuzzer target where the compiler brings none: every file of a corpus, then changed copies of them.
//
//     TARGET CORPUS... [-runs=N] [-seed=S]
#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>
#include <string>
#include <vector>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

namespace {

namespace fs = std::filesystem;

void test(const std::string& input) {
    LLVMFuzzerTestOneInput(reinterpret_cast<const std::uint8_t*>(input.data()), input.size());
}

std::vector<std::string> read_corpus(const fs::path& place) {
    std::vector<fs::path> files;
    if (fs::is_directory(place))
        for (const auto& entry : fs::directory_iterator(place)) {
            if (entry.is_regular_file()) files.push_back(entry.path());
        }
    else
        files.push_back(place);
    std::sort(files.begin(), files.end());
    std::vector<std::string> corpus;
    for (const fs::path& file : files) {
        std::ifstream in(file, std::ios::binary);
        corpus.emplace_back(std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>());
    }
    return corpus;
}

/// Bits flipped, bytes set, pieces cut, doubled or taken from another input.
std::string changed(std::string text, const std::vector<std::string>& corpus, std::mt19937& random) {
    const auto below = [&](std::size_t n) { return static_cast<std::size_t>(random()) % std::max<std::size_t>(n, 1); };
    for (std::size_t i = 1 + below(4); i > 0; --i) {
        if (text.empty()) text = corpus[below(corpus.size())];
        const std::size_t at = below(text.size());
        switch (below(5)) {
            case 0:
                text[at] ^= static_cast<char>(1u << below(8));
                break;
            case 1:
                text[at] = static_cast<char>(below(256));
                break;
            case 2:
                text.erase(at, 1 + below(16));
                break;
            case 3:
                text.insert(at, text.substr(below(text.size()), 1 + below(64)));
                break;
            default: {
                const std::string& other = corpus[below(corpus.size())];
                text.replace(at, 1 + below(64), other.substr(below(other.size()), 1 + below(64)));
            }
        }
    }
    return text;
}

}  // namespace

int main(int argc, char** argv) {
    std::vector<std::string> corpus;
    unsigned long runs = 0, seed = 1;
    for (int i = 1; i < argc; ++i) {
        const std::string argument = argv[i];
        if (argument.starts_with("-runs="))
            runs = std::stoul(argument.substr(6));
        else if (argument.starts_with("-seed="))
            seed = std::stoul(argument.substr(6));
        else
            for (std::string& text : read_corpus(argument)) corpus.push_back(std::move(text));
    }
    if (corpus.empty()) corpus.emplace_back();
    for (const std::string& text : corpus) test(text);
    for (unsigned long run = 0; run < runs; ++run) {
        std::mt19937 random(static_cast<unsigned>(seed + run));
        const std::string input = changed(corpus[random() % corpus.size()], corpus, random);
        // What ends the program can be looked at.
        std::ofstream("fuzz-input", std::ios::binary) << input;
        test(input);
    }
    fs::remove("fuzz-input");
    std::printf("%zu files and %lu changed copies\n", corpus.size(), runs);
}
