#include <fmt/format.h>

#include <algorithm>

#include "shell_files.hpp"

namespace agricolmap {
namespace {

std::vector<std::string> namesOf(const CLI::Option& option) {
  std::vector<std::string> names;
  for (const std::string& name : option.get_lnames()) names.push_back("--" + name);
  for (const std::string& name : option.get_snames()) names.push_back("-" + name);
  return names;
}

std::string wordsOf(const CLI::App& app) {
  std::string words;
  for (const CLI::Option* option : flagsOf(app)) {
    for (const std::string& name : namesOf(*option)) words += (words.empty() ? "" : " ") + name;
  }
  return words;
}

std::string verbNames(const CLI::App& app) {
  std::string names;
  for (const CLI::App* verb : verbsOf(app)) names += (names.empty() ? "" : " ") + verb->get_name();
  return names;
}

/// Text between single quotes, of which zsh's _arguments sees no brackets and colons.
std::string quoted(const std::string& text) {
  std::string safe;
  for (const char c : text.substr(0, text.find('\n'))) {
    if (c == '\'') {
      safe += "'\\''";
    } else if (c == '[' || c == ']' || c == ':' || c == '\\') {
      safe += '\\';
      safe += c;
    } else {
      safe += c;
    }
  }
  return safe;
}

std::string zshFlags(const CLI::App& app) {
  std::string text;
  for (const CLI::Option* option : flagsOf(app)) {
    const bool value = option->get_items_expected_max() > 0;
    for (const std::string& name : namesOf(*option)) {
      text += fmt::format(" \\\n        '{}[{}]{}'", name, quoted(option->get_description()),
                          value ? ":value:_files" : "");
    }
  }
  return text;
}

}  // namespace

std::vector<const CLI::App*> verbsOf(const CLI::App& app) {
  std::vector<const CLI::App*> verbs =
      app.get_subcommands([](const CLI::App* verb) { return !verb->get_group().empty(); });
  return verbs;
}

std::vector<const CLI::Option*> flagsOf(const CLI::App& app) {
  return app.get_options([](const CLI::Option* option) {
    return !option->get_positional() && !option->get_group().empty();
  });
}

std::string bashCompletion(const CLI::App& app) {
  std::string cases;
  for (const CLI::App* verb : verbsOf(app)) {
    cases += fmt::format("    {}) flags=\"{}\" ;;\n", verb->get_name(), wordsOf(*verb));
  }
  return fmt::format(
      "# bash completion for agricolmap(1)\n"
      "_agricolmap() {{\n"
      "  local word=${{COMP_WORDS[COMP_CWORD]}} verb= flags= i\n"
      "  for ((i = 1; i < COMP_CWORD; ++i)); do\n"
      "    if [[ ' {0} ' == *\" ${{COMP_WORDS[i]}} \"* ]]; then verb=${{COMP_WORDS[i]}} && break; "
      "fi\n"
      "  done\n"
      "  case $verb in\n{1}  esac\n"
      "  if [[ $word == -* ]]; then\n"
      "    mapfile -t COMPREPLY < <(compgen -W \"$flags {2}\" -- \"$word\")\n"
      "  elif [[ -z $verb ]]; then\n"
      "    mapfile -t COMPREPLY < <(compgen -W '{0}' -- \"$word\")\n"
      "  fi\n"
      "}}\n"
      "complete -o default -F _agricolmap agricolmap\n",
      verbNames(app), cases, wordsOf(app));
}

std::string zshCompletion(const CLI::App& app) {
  std::string verbs;
  std::string cases;
  for (const CLI::App* verb : verbsOf(app)) {
    verbs += fmt::format("    '{}:{}'\n", verb->get_name(), quoted(verb->get_description()));
    cases += fmt::format("    {})\n      _arguments{}{} \\\n        '*:file:_files' ;;\n",
                         verb->get_name(), zshFlags(*verb), zshFlags(app));
  }
  return fmt::format(
      "#compdef agricolmap\n"
      "_agricolmap() {{\n"
      "  local -a verbs=(\n{0}  )\n"
      "  local verb=${{words[(r)({1})]}}\n"
      "  if [[ -z $verb ]]; then\n"
      "    _arguments{2} \\\n        '1:verb:->verb'\n"
      "    [[ $state == verb ]] && _describe verb verbs\n"
      "    return\n"
      "  fi\n"
      "  case $verb in\n{3}  esac\n"
      "}}\n"
      "_agricolmap \"$@\"\n",
      verbs,
      [&] {
        std::string n = verbNames(app);
        std::ranges::replace(n, ' ', '|');
        return n;
      }(),
      zshFlags(app), cases);
}

}  // namespace agricolmap
