#include <fmt/format.h>

#include <algorithm>

#include "base/progress.h"
#include "base/text_line.h"
#include "cli/command.h"

namespace pendular::cli {
namespace {

// Manual pages and completions, from the texts that --help shows.

std::vector<const CLI::App*> commands_of(const CLI::App& app) {
  return app.get_subcommands([](const CLI::App* command) { return !command->get_group().empty(); });
}

std::vector<const CLI::Option*> options_of(const CLI::App& app, bool positional) {
  auto options = app.get_options([&](const CLI::Option* option) {
    return !option->get_group().empty() && option->get_positional() == positional;
  });
  return {options.begin(), options.end()};
}

bool takes_value(const CLI::Option& option) {
  return option.get_items_expected_max() > 0 && option.get_type_size_max() > 0;
}

/// "-o", "--out".
std::vector<std::string> words_of(const CLI::Option& option) {
  std::vector<std::string> words;
  for (const auto& name : option.get_snames()) words.push_back("-" + name);
  for (const auto& name : option.get_lnames()) words.push_back("--" + name);
  return words;
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  for (auto at = text.find(from); at != std::string::npos; at = text.find(from, at + to.size()))
    text.replace(at, from.size(), to);
  return text;
}

// ---- man(7) ----

/// Text in which no character is a request or an escape.
std::string roff(const std::string& text) {
  std::string safe = replaced(replaced(text, "\\", "\\e"), "-", "\\-");
  if (!safe.empty() && (safe[0] == '.' || safe[0] == '\'')) safe = "\\&" + safe;
  return replaced(replaced(safe, "\n.", "\n\\&."), "\n'", "\n\\&'");
}

std::string roff_option(const CLI::Option& option) {
  std::string names;
  for (const auto& word : words_of(option))
    names += (names.empty() ? "" : ", ") + fmt::format("\\fB{}\\fR", roff(word));
  if (names.empty())
    names = fmt::format("\\fI{}\\fR", roff(option.get_name()));
  else if (takes_value(option))
    names += fmt::format(" \\fI{}\\fR", roff(option.get_type_name()));
  const std::string preset =
      option.get_default_str().empty() ? "" : fmt::format(" [{}]", option.get_default_str());
  return fmt::format(".TP\n{}\n{}\n", names, roff(option.get_description() + preset));
}

std::string roff_options(const CLI::App& app) {
  std::string text;
  for (const bool positional : {true, false})
    for (const auto* option : options_of(app, positional)) text += roff_option(*option);
  return text;
}

std::string head(const std::string& title) {
  return fmt::format(".TH {} 1 \"\" \"pendular {}\" \"User Commands\"\n", roff(title), program_version());
}

std::string synopsis(const std::string& name, const CLI::App& command) {
  std::string text = fmt::format("\\fB{}\\fR", roff(name));
  for (const auto* option : options_of(command, true)) {
    const std::string argument = fmt::format("\\fI{}\\fR", roff(option->get_name()));
    text += option->get_required() ? " " + argument : fmt::format(" [{}]", argument);
  }
  return text + (options_of(command, false).empty() ? "" : " [\\fIoptions\\fR]");
}

std::string page_of(const CLI::App& command) {
  const std::string name = "pendular " + command.get_name(), about = command.get_description();
  const std::string first = about.substr(0, std::min(about.find('\n'), about.find(". ")));
  std::string page = head("pendular-" + command.get_name());
  page += fmt::format(".SH NAME\npendular\\-{} \\- {}\n", roff(command.get_name()), roff(first));
  page += fmt::format(".SH SYNOPSIS\n{}\n.SH DESCRIPTION\n{}\n", synopsis(name, command), roff(about));
  page += ".SH OPTIONS\n" + roff_options(command);
  for (const auto* inner : commands_of(command))
    page += fmt::format(".SS {}\n{}\n.PP\n{}\n{}", roff(inner->get_name()),
                        synopsis(name + " " + inner->get_name(), *inner), roff(inner->get_description()),
                        roff_options(*inner));
  return page + ".SH SEE ALSO\n\\fBpendular\\fR(1)\n";
}

std::string first_page(const CLI::App& app) {
  std::string page = head("pendular");
  page += fmt::format(
      ".SH NAME\npendular \\- {}\n.SH SYNOPSIS\n\\fBpendular\\fR \\fIcommand\\fR [\\fIoptions\\fR]\n",
      roff(app.get_description()));
  page += ".SH COMMANDS\n";
  for (const auto* command : commands_of(app))
    page += fmt::format(".TP\n\\fB{}\\fR\n{}\n", roff(command->get_name()), roff(command->get_description()));
  page += ".SH OPTIONS\n" + roff_options(app);
  return page +
         ".SH EXIT STATUS\n0 done, 2 wrong usage, 3 bad input, 4 the computation failed, 130 interrupted.\n";
}

// ---- Completions ----

std::string joined(const std::vector<std::string>& words) {
  std::string text;
  for (const auto& word : words) text += (text.empty() ? "" : " ") + word;
  return text;
}

std::vector<std::string> option_words(const CLI::App& command) {
  std::vector<std::string> words;
  for (const auto* option : options_of(command, false))
    for (const auto& word : words_of(*option)) words.push_back(word);
  return words;
}

std::vector<std::string> names_of(const CLI::App& app) {
  std::vector<std::string> names;
  for (const auto* command : commands_of(app)) names.push_back(command->get_name());
  return names;
}

std::string bash(const CLI::App& app) {
  std::string cases;
  for (const auto* command : commands_of(app)) {
    auto words = names_of(*command);
    for (const auto* inner : commands_of(*command))
      for (const auto& word : option_words(*inner)) words.push_back(word);
    for (const auto& word : option_words(*command)) words.push_back(word);
    std::sort(words.begin(), words.end());
    words.erase(std::unique(words.begin(), words.end()), words.end());
    cases += fmt::format("    {}) words=\"{}\" ;;\n", command->get_name(), joined(words));
  }
  auto start = names_of(app);
  for (const auto& word : option_words(app)) start.push_back(word);
  return fmt::format(
      "# bash completion for pendular\n"
      "_pendular() {{\n"
      "  local words=\"{}\" current=\"${{COMP_WORDS[COMP_CWORD]}}\"\n"
      "  ((COMP_CWORD > 1)) && case \"${{COMP_WORDS[1]}}\" in\n{}    *) words=\"\" ;;\n  esac\n"
      "  COMPREPLY=($(compgen -W \"$words\" -- \"$current\"))\n"
      "}}\n"
      "complete -o default -F _pendular pendular\n",
      joined(start), cases);
}

/// One line in single quotes, without what a specification of _arguments gives a meaning.
std::string zsh_text(const std::string& text) {
  std::string line = replaced(pendular::text_line(text.substr(0, text.find('\n'))), "'", "'\\''");
  for (const char* special : {"[", "]", ":"}) line = replaced(line, special, std::string("\\") + special);
  return line;
}

std::string zsh_options(const CLI::App& command) {
  std::string text;
  for (const auto* option : options_of(command, false))
    for (const auto& word : words_of(*option))
      text += fmt::format(" \\\n        '{}[{}]{}'", word, zsh_text(option->get_description()),
                          takes_value(*option) ? ":value:_files" : "");
  return text;
}

std::string zsh(const CLI::App& app) {
  std::string commands, cases;
  for (const auto* command : commands_of(app)) {
    commands += fmt::format("    '{}:{}'\n", command->get_name(), zsh_text(command->get_description()));
    std::string options = zsh_options(*command);
    for (const auto* inner : commands_of(*command)) options += zsh_options(*inner);
    const auto inner = names_of(*command);
    const std::string first =
        inner.empty() ? "" : fmt::format(" \\\n        '1:command:({})'", joined(inner));
    cases +=
        fmt::format("      {}) _arguments{}{} '*:file:_files' ;;\n", command->get_name(), options, first);
  }
  return fmt::format(
      "#compdef pendular\n"
      "_pendular() {{\n"
      "  local -a commands=(\n{}  )\n"
      "  local context state line\n"
      "  _arguments -C '1:command:->command' '*::argument:->argument'\n"
      "  case $state in\n"
      "    command) _describe command commands ;;\n"
      "    argument) case $words[1] in\n{}      esac ;;\n"
      "  esac\n"
      "}}\n"
      "_pendular \"$@\"\n",
      commands, cases);
}

void write(const CLI::App& app, const fs::path& out) {
  make_folder(out / "man1");
  write_text(out / "man1" / "pendular.1", first_page(app));
  for (const auto* command : commands_of(app))
    write_text(out / "man1" / fmt::format("pendular-{}.1", command->get_name()), page_of(*command));
  write_text(out / "pendular.bash", bash(app));
  write_text(out / "_pendular", zsh(app));
}

}  // namespace

void add_manual(CLI::App& app) {
  auto out = std::make_shared<fs::path>();
  auto* command =
      app.add_subcommand("manual", "Manual pages and completions, as installation puts them")->group("");
  command->add_option("out", *out)->required();
  command->callback([out, &app] { write(app, *out); });
}

}  // namespace pendular::cli
