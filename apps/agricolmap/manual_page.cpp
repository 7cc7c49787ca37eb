#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <string_view>

#include "shell_files.hpp"

namespace agricolmap {
namespace {

/// Text in which roff sees no commands.
std::string plain(std::string_view text) {
  std::string safe;
  bool line_begins = true;
  for (const char c : text) {
    if (line_begins && (c == '.' || c == '\'')) safe += "\\&";
    if (c == '\\') {
      safe += "\\e";
    } else if (c == '-') {
      safe += "\\-";
    } else {
      safe += c;
    }
    line_begins = c == '\n';
  }
  return safe;
}

std::string namesOf(const CLI::Option& option) {
  std::string names;
  for (const std::string& name : option.get_snames()) names += fmt::format("\\fB\\-{}\\fR, ", name);
  for (const std::string& name : option.get_lnames()) {
    names += fmt::format("\\fB\\-\\-{}\\fR, ", plain(name));
  }
  if (names.ends_with(", ")) names.resize(names.size() - 2);
  const bool takes_value = option.get_items_expected_max() > 0;
  return takes_value ? names + " \\fIVALUE\\fR" : names;
}

std::string entry(const std::string& head, const CLI::Option& option) {
  return fmt::format(".TP\n{}\n{}\n", head, plain(option.get_description()));
}

std::string optionsOf(const CLI::App& app) {
  std::string text;
  std::string group;
  for (const CLI::Option* option : flagsOf(app)) {
    if (option->get_group() != group) {
      group = option->get_group();
      if (group != "Options") text += fmt::format(".SS \"{}\"\n", plain(group));
    }
    text += entry(namesOf(*option), *option);
  }
  return text;
}

std::string synopsis(const CLI::App& verb) {
  std::string line =
      fmt::format("\\fBagricolmap {}\\fR [\\fIOPTION\\fR...]", plain(verb.get_name()));
  for (const CLI::Option* option : verb.get_options()) {
    if (!option->get_positional()) continue;
    const std::string name = option->get_name(true, false);
    const bool many = option->get_items_expected_max() > 1;
    const std::string shown = fmt::format("\\fI{}\\fR{}", plain(name), many ? "..." : "");
    line += option->get_required() ? " " + shown : " [" + shown + "]";
  }
  return line + "\n";
}

std::string operands(const CLI::App& verb) {
  std::string text;
  for (const CLI::Option* option : verb.get_options()) {
    if (!option->get_positional()) continue;
    text += entry(fmt::format("\\fI{}\\fR", plain(option->get_name(true, false))), *option);
  }
  return text;
}

std::string exitStatus() {
  constexpr std::pair<int, const char*> kCodes[] = {
      {0, "Done; of a registration: accepted."},
      {1, "Internal error, or out of memory."},
      {2, "Wrong usage."},
      {3, "Input that cannot be used."},
      {4, "Output that cannot be written."},
      {10, "The registration was rejected."},
      {11, "The registration is ambiguous: several places fit about equally well."},
      {12, "Some strips of a batch came to no answer; the others have theirs."},
      {130,
       "Interrupted; nothing was written, but strips that a batch had finished stay (--resume)."}};
  std::string text = ".SH \"EXIT STATUS\"\n";
  for (const auto& [code, words] : kCodes) text += fmt::format(".TP\n{}\n{}\n", code, words);
  return text;
}

std::string heading(const std::string& name, const std::string& about) {
  std::string upper = name;
  std::ranges::transform(upper, upper.begin(), [](unsigned char c) { return std::toupper(c); });
  return fmt::format(".TH {} 1 \"\" \"AgriColMap {}\" \"User Commands\"\n.SH NAME\n{} \\- {}\n",
                     plain(upper), AGRICOLMAP_VERSION, plain(name), plain(about));
}

std::string ofWhole(const CLI::App& app) {
  std::string text =
      heading("agricolmap", "lay a ground robot's map of a crop field into a drone's");
  text +=
      ".SH SYNOPSIS\n\\fBagricolmap\\fR [\\fIOPTION\\fR...] \\fIVERB\\fR [\\fIARGUMENT\\fR...]\n";
  text += fmt::format(".SH DESCRIPTION\n{}\n.SH VERBS\n", plain(app.get_description()));
  std::string see;
  for (const CLI::App* verb : verbsOf(app)) {
    text += fmt::format(".TP\n\\fB{}\\fR\n{}\n", plain(verb->get_name()),
                        plain(verb->get_description()));
    see += fmt::format("{}\\fBagricolmap\\-{}\\fR(1)", see.empty() ? "" : ",\n",
                       plain(verb->get_name()));
  }
  text += ".SH OPTIONS\nEvery verb takes these:\n" + optionsOf(app) + exitStatus();
  return text + ".SH \"SEE ALSO\"\n" + see + "\n";
}

}  // namespace

std::string manualPage(const CLI::App& app, const CLI::App* verb) {
  if (verb == nullptr) return ofWhole(app);
  const std::string name = "agricolmap-" + verb->get_name();
  std::string about = verb->get_description();
  about = about.substr(0, about.find(':'));
  std::string text = heading(name, about) + ".SH SYNOPSIS\n" + synopsis(*verb);
  text += fmt::format(".SH DESCRIPTION\n{}.\n{}", plain(verb->get_description()), operands(*verb));
  text += ".SH OPTIONS\n" + optionsOf(*verb);
  if (verb->get_option_no_throw("--help-all") != nullptr) {
    text += fmt::format(
        ".PP\nThose for people who change how a stage works are told by\n\\fBagricolmap {} "
        "\\-\\-help\\-all\\fR.\n",
        plain(verb->get_name()));
  }
  return text + exitStatus() + ".SH \"SEE ALSO\"\n\\fBagricolmap\\fR(1)\n";
}

}  // namespace agricolmap
