// Runs obscura-evaluate from the command line, and makes small frames for it.
#pragma once

#include <filesystem>
#include <string>

#include "../shell.h"
#include "truth/captured_frame.h"

namespace obscura::evaluate {

using test::Ended;
using test::shellCommand;
Ended runTool(const std::string& arguments);  // quoted by shellCommand()

// A temporary folder, removed with the object.
class Scratch {
public:
    Scratch();
    ~Scratch();
    std::filesystem::path operator/(const std::string& name) const { return m_folder / name; }
    const std::filesystem::path& folder() const { return m_folder; }
    size_t files() const;

private:
    std::filesystem::path m_folder;
};

std::string textOf(const std::filesystem::path& file);
// A floor and a wall: 64 x 36 px and a guard band of 6 x 4 px.
truth::CapturedFrame cornerFrame();

}  // namespace obscura::evaluate
