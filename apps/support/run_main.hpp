// What the `main` of the smaller programs does.
#pragma once

#include <CLI/CLI.hpp>
#include <functional>

namespace agricolmap {

/// Parses the arguments and does what they ask for. What is thrown is said on standard error,
/// behind the name of `app`. Returns the exit code.
int runMain(CLI::App& app, int argc, char** argv, const std::function<void()>& action);

}  // namespace agricolmap
