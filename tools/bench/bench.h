// The measuring itself, kept in OUT/parts every few seconds, so that an interrupted run goes on where it stopped.
#pragma once

#include "options.h"
#include "results.h"

namespace obscura::bench {

// Throws app::Complaint or scene::Error.
Results measure(const Options& options, evaluate::Machine& machine);

}  // namespace obscura::bench
