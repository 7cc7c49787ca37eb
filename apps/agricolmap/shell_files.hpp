// What a system has of a program beside itself: manual pages and completions, from the same flags
// as the command line.
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

namespace agricolmap {

/// The verbs that people use.
std::vector<const CLI::App*> verbsOf(const CLI::App& app);

/// Flags that the help shows, longest name first, in their order.
std::vector<const CLI::Option*> flagsOf(const CLI::App& app);

/// A page of section 1 in the language of man(7): of `verb`, or of the whole without one.
std::string manualPage(const CLI::App& app, const CLI::App* verb);

/// Scripts that complete verbs, flags and names of files.
std::string bashCompletion(const CLI::App& app);
std::string zshCompletion(const CLI::App& app);

}  // namespace agricolmap
