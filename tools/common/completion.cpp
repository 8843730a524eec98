// SPDX-License-Identifier: MIT
#include "common/completion.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <regex>
#include <vector>

#include "meshbound/error.h"

namespace meshbound::tools {
namespace {

/// A long option as a shell sees it.
struct Word {
  std::string name;  ///< with its dashes
  std::string description;
  bool has_value = false;
  std::vector<std::string> choices;  ///< of the value; empty: any, a file perhaps
};

/// The values that a type such as "TEXT:{skip,stop}" allows.
std::vector<std::string> choices_of(const std::string& type) {
  std::vector<std::string> choices;
  const std::size_t begin = type.find('{'), end = type.find('}');
  if (begin == std::string::npos || end == std::string::npos) return choices;
  const std::regex word("[^,]+");
  const std::string list = type.substr(begin + 1, end - begin - 1);
  for (std::sregex_iterator it(list.begin(), list.end(), word), none; it != none; ++it) choices.push_back(it->str());
  return choices;
}

std::vector<Word> words_of(const CLI::App& app) {
  std::vector<Word> words;
  for (const CLI::Option* option : app.get_options())
    for (const std::string& name : option->get_lnames())
      words.push_back({"--" + name, option->get_description(), option->get_items_expected_max() > 0,
                       choices_of(option->get_type_name())});
  return words;
}

std::string joined(const std::vector<std::string>& words, const char* between) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : between) + word;
  return text;
}

/// Removes characters with a special meaning for zsh, for text between single quotes.
std::string without(std::string text, const std::string& unwanted) {
  std::erase_if(text, [&](char c) { return unwanted.find(c) != std::string::npos; });
  return text;
}

std::string for_bash(const std::string& tool, const std::vector<Word>& words) {
  std::string cases;
  std::vector<std::string> names, taking_files;
  for (const Word& word : words) {
    names.push_back(word.name);
    if (word.has_value && word.choices.empty()) taking_files.push_back(word.name);
    if (!word.choices.empty())
      cases += "    " + word.name + ") COMPREPLY=($(compgen -W '" + joined(word.choices, " ") +
               "' -- \"$word\")); return ;;\n";
  }
  return "# bash completion of " + tool + "\n_" + tool + "() {\n  local word=${COMP_WORDS[COMP_CWORD]}\n" +
         "  case ${COMP_WORDS[COMP_CWORD-1]} in\n" + cases + "    " + joined(taking_files, "|") +
         ") mapfile -t COMPREPLY < <(compgen -f -- \"$word\"); return ;;\n  esac\n" +
         "  if [[ $word == -* ]]; then\n    COMPREPLY=($(compgen -W '" + joined(names, " ") +
         "' -- \"$word\"))\n  else\n    mapfile -t COMPREPLY < <(compgen -f -- \"$word\")\n  fi\n}\ncomplete -o "
         "filenames -F _" +
         tool + " " + tool + "\n";
}

std::string for_zsh(const std::string& tool, const std::vector<Word>& words) {
  std::string text = "#compdef " + tool + "\n_arguments \\\n";
  for (const Word& word : words) {
    text += "  '" + word.name + "[" + without(word.description, "'[]:\\") + "]";
    if (!word.choices.empty())
      text += ":value:(" + joined(word.choices, " ") + ")";
    else if (word.has_value)
      text += ":value:_files";
    text += "' \\\n";
  }
  return text + "  '*:file:_files'\n";
}

std::string for_fish(const std::string& tool, const std::vector<Word>& words) {
  std::string text = "# fish completion of " + tool + "\n";
  for (const Word& word : words) {
    text += "complete -c " + tool + " -l " + word.name.substr(2) + " -d '" + without(word.description, "'\\") + "'";
    if (!word.choices.empty())
      text += " -x -a '" + joined(word.choices, " ") + "'";
    else if (word.has_value)
      text += " -r";
    text += '\n';
  }
  return text;
}

}  // namespace

std::string completion_script(const CLI::App& app, const std::string& shell) {
  const std::vector<Word> words = words_of(app);
  if (shell == "bash") return for_bash(app.get_name(), words);
  if (shell == "zsh") return for_zsh(app.get_name(), words);
  if (shell == "fish") return for_fish(app.get_name(), words);
  throw InvalidInput("--completion " + shell + ": there are scripts for bash, zsh and fish");
}

}  // namespace meshbound::tools
