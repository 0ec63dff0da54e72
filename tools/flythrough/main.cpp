// Entry point of obscura-flythrough: parses the command line, runs the job, writes the results; a failure is one line and an exit code.
#include <algorithm>
#include <cstdio>

#include <fmt/format.h>

#include "app/complaint.h"
#include "app/files.h"
#include "gate.h"
#include "report.h"

namespace obscura::flythrough {
namespace {

namespace fs = std::filesystem;

std::vector<fs::path> chunkFiles(const fs::path& folder) {
    std::vector<fs::path> files;
    std::error_code error;
    for (const auto& entry : fs::directory_iterator(folder / "parts", error))
        if (entry.path().extension() == ".json") files.push_back(entry.path());
    std::sort(files.begin(), files.end());
    return files;
}

void finish(const std::vector<Chunk>& chunks, const std::string& device, const Options& options) {
    std::fputs(table(chunks).c_str(), stdout);
    writeReport(chunks, device, options.settings.out);
    if (options.video) writeVideos(chunks, options.settings.out);
    fmt::print("{}\n", (options.settings.out / "report.html").string());
}

int fly(const Options& options) {
    const fs::path& out = options.settings.out;
    app::expectFolder(out / "parts");
    measure::Machine machine({options.device, options.validation, options.verbose});
    std::vector<Chunk> chunks;
    for (const Script& script : options.scripts) {
        Flight flight(machine, script, options.settings);
        if (options.settings.pictures) flight.writeReferencePictures();
        for (const measure::Candidate& candidate : options.candidates)
            for (const ao::Preset* filter : options.filters) {
                const Chunk wanted = flight.empty(candidate, *filter);
                const fs::path file = out / "parts" / fmt::format("{}.{}-{}.json", wanted.name(), wanted.first, wanted.end);
                std::optional<Chunk> chunk = options.again ? std::nullopt : readChunk(file);
                if (!chunk || chunk->key != wanted.key) {
                    chunk = flight.measure(candidate, *filter);
                    app::writeFile(file, chunkText(*chunk));
                }
                chunks.push_back(std::move(*chunk));
            }
    }
    finish(joined(std::move(chunks)), machine.deviceName(), options);
    return machine.device().validationMessages() ? app::kInvalidUse : 0;
}

int merge(const Options& options) {
    const fs::path& out = options.settings.out;
    app::expectFolder(out / "parts");
    std::vector<Chunk> chunks;
    for (const fs::path& folder : options.merged) {
        const std::vector<fs::path> files = chunkFiles(folder);
        if (files.empty())
            throw app::Complaint(
                fmt::format("--merge {}: contains no chunks of a run; name folders that earlier runs wrote with --out", folder.string()));
        for (const fs::path& file : files) {
            const auto chunk = readChunk(file);
            if (!chunk) throw app::Complaint(fmt::format("{}: is damaged; measure these frames again", file.string()));
            chunks.push_back(*chunk);
        }
        std::error_code ignored;
        if (fs::is_directory(folder / "frames", ignored) && !fs::equivalent(folder, out, ignored))
            fs::copy(folder / "frames", out / "frames", fs::copy_options::recursive | fs::copy_options::update_existing);
    }
    chunks = joined(std::move(chunks));
    for (const Chunk& chunk : chunks)
        app::writeFile(out / "parts" / fmt::format("{}.{}-{}.json", chunk.name(), chunk.first, chunk.end), chunkText(chunk));
    finish(chunks, "", options);
    return 0;
}

int run(int argc, char** argv) {
    const auto options = parseOptions(argc, argv);
    if (!options) return 0;
    switch (options->job) {
        case Job::fly: return fly(*options);
        case Job::merge: return merge(*options);
        case Job::printJobs: std::fputs(jobList(*options).c_str(), stdout); return 0;
        case Job::checkBaseline: return checkBaseline(*options);
        case Job::renewBaseline: return renewBaseline(*options);
    }
    return 0;
}

}  // namespace
}  // namespace obscura::flythrough

int main(int argc, char** argv) {
    return obscura::app::guarded("obscura-flythrough", [&] { return obscura::flythrough::run(argc, argv); });
}
