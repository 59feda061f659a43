// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <initializer_list>
#include <string_view>

#include "command_line/write_manuals.h"

namespace cdprep::cli {
namespace {

/// Returns true for values that a shell completes as paths.
bool is_path(const std::string& value) {
    return value == "FILE" || value == "FOLDER" || value == "FILES" || value == "PATTERN" ||
           value == "SCENE";
}

std::string joined(const std::vector<std::string>& words) {
    std::string text;
    for (const std::string& word : words) text += (text.empty() ? "" : " ") + word;
    return text;
}

std::vector<const OptionEntry*> options_of(const CommandPage& page) {
    std::vector<const OptionEntry*> options;
    for (const OptionGroup& group : page.groups) {
        for (const OptionEntry& option : group.options) options.push_back(&option);
    }
    return options;
}

std::vector<std::string> command_names(const CommandPage& page) {
    std::vector<std::string> names;
    for (const auto& [name, summary] : page.commands) names.push_back(name);
    return names;
}

/// Returns the text in single quotes of a shell.
std::string shell_quoted(const std::string& text) {
    std::string out = "'";
    for (const char letter : text) out += letter == '\'' ? "'\\''" : std::string(1, letter);
    return out + "'";
}

/// Returns the text with an escape before each character that zsh interprets in the description
/// of an option.
std::string for_zsh(const std::string& text) {
    std::string out;
    for (const char letter : text) {
        if (letter == '[' || letter == ']' || letter == ':' || letter == '\\') out += '\\';
        out += letter;
    }
    return out;
}

/// Returns the name of a function: "_cdprep_query_collide" for "cdprep query collide".
std::string function_name(const std::string& name) {
    std::string out = "_" + name;
    std::ranges::replace(out, ' ', '_');
    return out;
}

std::string concat(std::initializer_list<std::string_view> parts) {
    std::string text;
    for (const std::string_view part : parts) text += part;
    return text;
}

}  // namespace

std::string bash_completion(const std::vector<CommandPage>& pages) {
    std::string text =
        "# bash completion for cdprep. Generated from its options.\n"
        "_cdprep() {\n"
        "    local word=\"${COMP_WORDS[COMP_CWORD]}\" before=\"${COMP_WORDS[COMP_CWORD-1]}\"\n"
        "    local path=cdprep i\n"
        "    for ((i = 1; i < COMP_CWORD; ++i)); do\n"
        "        case \"$path ${COMP_WORDS[i]}\" in\n";
    for (const CommandPage& page : pages) {
        if (page.name.find(' ') != std::string::npos) {
            const std::string path = shell_quoted(page.name);
            text += concat({"            ", path, ") path=", path, " ;;\n"});
        }
    }
    text +=
        "        esac\n"
        "    done\n"
        "    local begun=\"\"\n"
        "    [[ $word == *,* ]] && begun=\"${word%,*},\"\n"
        "    COMPREPLY=()\n"
        "    case \"$path $before\" in\n";
    for (const CommandPage& page : pages) {
        for (const OptionEntry* option : options_of(page)) {
            if (option->words.empty()) continue;
            std::string names;
            for (const std::string& name : option->names) {
                names += (names.empty() ? "" : "|") + shell_quoted(page.name + " " + name);
            }
            const std::string_view last =
                option->is_list ? "-P \"$begun\" -- \"${word##*,}\"" : "-- \"$word\"";
            text += concat({"        ", names, ")\n            COMPREPLY=($(compgen -W ",
                            shell_quoted(joined(option->words)), " ", last, ")); return ;;\n"});
        }
    }
    text +=
        "    esac\n"
        "    case \"$path\" in\n";
    for (const CommandPage& page : pages) {
        std::vector<std::string> words = command_names(page);
        for (const OptionEntry* option : options_of(page)) {
            words.insert(words.end(), option->names.begin(), option->names.end());
        }
        text += concat({"        ", shell_quoted(page.name), ") COMPREPLY=($(compgen -W ",
                        shell_quoted(joined(words)), " -- \"$word\")) ;;\n"});
    }
    text +=
        "    esac\n"
        "    [[ $word == -* ]] || COMPREPLY+=($(compgen -f -- \"$word\"))\n"
        "}\n"
        "complete -o filenames -F _cdprep cdprep\n";
    return text;
}

std::string zsh_completion(const std::vector<CommandPage>& pages) {
    std::string text = "#compdef cdprep\n# Generated from the options of cdprep.\n\n";
    for (const CommandPage& page : pages) {
        text += function_name(page.name) + "() {\n";
        if (!page.commands.empty()) {
            text += "    local -a commands=(\n";
            for (const auto& [name, summary] : page.commands) {
                text += concat({"        ", shell_quoted(name + ":" + for_zsh(summary)), "\n"});
            }
            text += "    )\n    local curcontext=\"$curcontext\" state line\n";
        }
        text += "    _arguments -C \\\n";
        for (const OptionEntry* option : options_of(page)) {
            for (const std::string& name : option->names) {
                std::string spec = (option->is_repeatable ? "*" : "") + name;
                spec += "[" + for_zsh(option->text) + "]";
                if (option->is_list) {
                    spec += ":value:_values -s , value " + joined(option->words);
                } else if (!option->words.empty()) {
                    spec += ":value:(" + joined(option->words) + ")";
                } else if (is_path(option->value)) {
                    spec += option->value == "FOLDER" ? ":folder:_files -/" : ":file:_files";
                } else if (!option->value.empty()) {
                    spec += ":" + option->value + ":";
                }
                text += concat({"        ", shell_quoted(spec), " \\\n"});
            }
        }
        if (page.commands.empty()) {
            text += "        '*:file:_files'\n";
        } else {
            text +=
                "        '1:command:->command' '*::argument:->argument'\n"
                "    case $state in\n"
                "        command) _describe command commands ;;\n"
                "        argument) " +
                function_name(page.name) + "_$line[1] ;;\n    esac\n";
        }
        text += "}\n\n";
    }
    return text + "_cdprep \"$@\"\n";
}

std::string fish_completion(const std::vector<CommandPage>& pages) {
    std::string text = "# fish completion for cdprep. Generated from its options.\n";
    for (const CommandPage& page : pages) {
        std::vector<std::string> path;
        std::size_t begin = page.name.find(' ');
        while (begin != std::string::npos) {
            const std::size_t end = page.name.find(' ', begin + 1);
            path.push_back(page.name.substr(begin + 1, end - begin - 1));
            begin = end;
        }
        std::string when;
        for (const std::string& word : path) {
            when += (when.empty() ? "" : "; and ") + ("__fish_seen_subcommand_from " + word);
        }
        const std::string names = joined(command_names(page));
        if (!names.empty()) {
            when += (when.empty() ? "" : "; and ") + ("not __fish_seen_subcommand_from " + names);
        }
        const std::string start =
            "complete -c cdprep" + (when.empty() ? "" : " -n " + shell_quoted(when));
        for (const auto& [name, summary] : page.commands) {
            text.append(start).append(" -f -a ").append(name);
            text.append(" -d ").append(shell_quoted(summary)).append("\n");
        }
        for (const OptionEntry* option : options_of(page)) {
            text += start;
            for (const std::string& name : option->names) {
                text += name.starts_with("--") ? " -l " : " -s ";
                text += name.substr(name.starts_with("--") ? 2 : 1);
            }
            if (!option->value.empty()) text += is_path(option->value) ? " -r -F" : " -x";
            if (!option->words.empty()) {
                const std::string words = joined(option->words);
                text += " -a " + shell_quoted(option->is_list
                                                  ? concat({"(__fish_append , ", words, ")"})
                                                  : words);
            }
            text += " -d " + shell_quoted(option->text) + "\n";
        }
    }
    return text;
}

}  // namespace cdprep::cli
