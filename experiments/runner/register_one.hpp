// The verb `register-one`: one method on one pair of files, as a process of its own whose memory
// and time can be measured and limited from outside.
#pragma once

#include <CLI/CLI.hpp>
#include <functional>

namespace agricolmap::experiments {

/// Adds the verb to the program. Sets `action` when it is called; `idle_mib`: memory at the start.
void addRegisterOne(CLI::App& app, double idle_mib, std::function<void()>& action);

}  // namespace agricolmap::experiments
