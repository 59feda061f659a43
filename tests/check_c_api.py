#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Compares the C API with the C++ one, and with what it was.

    tests/check_c_api.py [--update] [--nm NM LIBRARY...]

Reads the public headers, and fails
- when a function of C++ has neither a function of C nor a reason in c_api_questions.txt;
- when docs/C_API.md does not hold the table that follows from it;
- when a struct, an enumerator or a function is not as in unit/lib/c/c_abi.inc;
- when the libraries do not export the functions of the headers.

--update writes the table and the list. A change that breaks programs needs a line in CHANGELOG.md.
"""
import argparse
import collections
import fnmatch
import pathlib
import re
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
INCLUDE = ROOT / "lib/include"
QUESTIONS = ROOT / "tests/c_api_questions.txt"
LIST = ROOT / "tests/unit/lib/c/c_abi.inc"
PAGE = ROOT / "docs/C_API.md"
BEGIN, END = "<!-- begin of the table -->\n", "<!-- end of the table -->\n"

# Sizes in bytes with 64 and with 32 bits. Alignments are the same, as on ARM, x86-64 and WebAssembly.
SIZES = {"char": (1, 1), "int": (4, 4), "uint32_t": (4, 4), "int32_t": (4, 4), "float": (4, 4),
         "uint64_t": (8, 8), "double": (8, 8), "size_t": (8, 4)}
POINTER = (8, 4)


def plain(text):
    """Removes comments, strings and directives."""
    text = re.sub(r"//[^\n]*|/\*.*?\*/", " ", text, flags=re.S)
    text = re.sub(r"^[ \t]*#(\\\n|[^\n])*", "", text, flags=re.M)
    return re.sub(r'"(\\.|[^"\\\n])*"', '""', text)


# --- The headers of C -----------------------------------------------------------------------------


class CApi:
    """The structs, enumerators and functions of the headers of C."""

    def __init__(self):
        self.values = {}  # enumerator: its number
        self.structs = {}  # name: [(field, its type, elements)]
        self.functions = {}  # name: (result, parameters, header)
        self.callbacks = {}  # name: (result, parameters)
        for header in sorted((INCLUDE / "cdprep/c").glob("*.h"), key=self.order_of):
            self.read(header)

    @staticmethod
    def order_of(header):
        """Headers come after those that they include."""
        order = ["base", "model", "build", "live", "pairs", "motion", "contacts", "points", "scene"]
        return (order.index(header.stem) if header.stem in order else len(order), header.stem)

    def read(self, header):
        text = header.read_text()
        for name, value in re.findall(r"^#define (CDPREP_[A-Z]+) (\d+)", text, re.M):
            self.values[name] = int(value)
        code = plain(text)
        for body in re.findall(r"\benum \{(.*?)\}", code, re.S):
            for name, value in re.findall(r"(\w+) = ([^,]+)", body):
                self.values[name] = eval(value, {}, dict(self.values))  # a sum of bits
        for name, body in re.findall(r"typedef struct (\w+) \{(.*?)\n\}", code, re.S):
            self.structs[name] = [field for line in body.split(";") if line.strip()
                                  for field in self.fields_of(line)]
        for result, name, given in re.findall(r"typedef ([\w ]+[ *]+)\(\*(\w+)\)\((.*?)\);", code,
                                              re.S):
            self.callbacks[name] = (self.type_of(result + "x"),
                                    [self.type_of(each) for each in given.split(",")])
        for result, name, given in re.findall(r"CDPREP_API ([\w ]+[ *]+)(\w+)\((.*?)\);", code,
                                              re.S):
            self.functions[name] = (self.type_of(result + "x"),
                                    [self.type_of(each) for each in given.split(",")],
                                    header.relative_to(INCLUDE))

    @staticmethod
    def fields_of(line):
        """The fields of one declaration: (name, type, number of elements)."""
        line = " ".join(line.split())
        function = re.search(r"\(\*(\w+)\)", line)
        if function:
            return [(function[1], "*", 1)]
        base, first = re.fullmatch(r"(?:const )?(\w+)(\W.*)", line).groups()
        fields = []
        for each in first.split(","):
            name, bounds = re.search(r"(\w+)((?:\[\d+\])*)$", each.strip()).groups()
            elements = 1
            for bound in re.findall(r"\d+", bounds):
                elements *= int(bound)
            fields.append((name, "*" if "*" in each else base, elements))
        return fields

    @staticmethod
    def type_of(parameter):
        """The type of a parameter, without its name."""
        parameter = " ".join(parameter.split())
        if parameter == "void":
            return parameter
        kind, is_array = re.fullmatch(r"(.*?)\w+(\[\d*\])?", parameter).groups()
        kind = kind.strip() + ("*" if is_array else "")
        return re.sub(r" ?\* ?", "*", kind)

    def size_of(self, kind):
        """(size, alignment), each with 64 and with 32 bits."""
        if kind == "*" or kind in self.callbacks:
            return POINTER, POINTER
        if kind in SIZES:
            return SIZES[kind], SIZES[kind]
        places = [self.layout_of(kind, bits) for bits in (0, 1)]
        return tuple(p[0] for p in places), tuple(p[1] for p in places)

    def layout_of(self, name, bits):
        """(size, alignment, offsets) of a struct."""
        end, alignment, offsets = 0, 1, []
        for _, kind, elements in self.structs[name]:
            size, align = (each[bits] for each in self.size_of(kind))
            end = -(-end // align) * align
            offsets.append(end)
            end += size * elements
            alignment = max(alignment, align)
        return -(-end // alignment) * alignment, alignment, offsets

    def list(self):
        """The lines of c_abi.inc."""
        yield "// SPDX-License-Identifier: MIT"
        yield "// Written by tests/check_c_api.py --update. What c_abi_test.cpp expects: sizes and"
        yield "// offsets with 64 and with 32 bits, numbers, and functions."
        for name in self.structs:
            wide, narrow = (self.layout_of(name, bits) for bits in (0, 1))
            yield f"CDPREP_STRUCT({name}, {wide[0]}, {narrow[0]})"
            for (field, _, _), at, at_32 in zip(self.structs[name], wide[2], narrow[2]):
                yield f"CDPREP_FIELD({name}, {field}, {at}, {at_32})"
        for name, value in self.values.items():
            yield f"CDPREP_VALUE({name}, {value})"
        for name, (result, given) in self.callbacks.items():
            yield f"CDPREP_CALLBACK({name}, {result}({', '.join(given)}))"
        for name, (result, given, _) in self.functions.items():
            yield f"CDPREP_FUNCTION({name}, {result}({', '.join(given)}))"


# --- The headers of C++ ---------------------------------------------------------------------------


class Scopes:
    """Reads one header of C++: its functions, and the public ones of its classes."""

    def __init__(self, text):
        text = plain(text)
        text = re.sub(r"\[\[.*?\]\]|\bCDPREP_[A-Z]+\b(?!\()", " ", text, flags=re.S)
        text = re.sub(r'extern ""', " ", text)
        self.text = text
        self.at = 0
        self.found = []
        self.scope([], None, True)

    def skip_braces(self):
        """Goes past the block that begins here."""
        depth = 0
        while True:
            depth += {"{": 1, "}": -1}.get(self.text[self.at], 0)
            self.at += 1
            if depth == 0:
                return

    def head(self):
        """The text up to the next ; { or } outside of parentheses, and that character."""
        begin, depth = self.at, 0
        while self.at < len(self.text):
            c = self.text[self.at]
            depth += {"(": 1, ")": -1}.get(c, 0)
            if depth == 0 and c in ";{}":
                return self.text[begin:self.at], c
            self.at += 1
        return self.text[begin:], ""

    def scope(self, names, owner, is_public):
        while True:
            head, last = self.head()
            for label in re.findall(r"\b(public|private|protected) *:(?!:)", head):
                is_public = label == "public"
            head = re.sub(r"\b(public|private|protected) *:(?!:)", " ", head)
            head = self.without_template(" ".join(head.split()))
            if last in ("}", ""):
                self.at += 1
                return
            if last == ";":
                self.at += 1
                self.declaration(head, names, owner, is_public)
                continue
            space = re.match(r"(?:inline )?namespace ?([\w:]*)", head)
            kind = re.match(r"(class|struct|union) ([\w:]+)", head)
            if space or (kind and "(" not in head):
                self.at += 1
                inner = names + ([space[1]] if space else kind[2].split("::"))
                owner_of = None if space else kind[2].split("::")[-1]
                self.scope(inner, owner_of,
                           is_public and (bool(space) or kind[1] != "class"))
            else:
                self.declaration(head, names, owner, is_public)
                self.skip_braces()
                while re.match(r"\s*[,{]", self.text[self.at:self.at + 80]):
                    self.at = self.text.index("{", self.at)
                    self.skip_braces()

    @staticmethod
    def without_template(head):
        """Removes template parameters and requirements in front of a declaration."""
        while head.startswith("template"):
            depth = 0
            for at, c in enumerate(head):
                depth += {"<": 1, ">": -1}.get(c, 0)
                if c == ">" and depth == 0:
                    head = head[at + 1:].strip()
                    break
        if head.startswith("requires"):
            depth = 0
            for at, c in enumerate(head):
                depth += {"(": 1, ")": -1}.get(c, 0)
                if c == ")" and depth == 0:
                    return head[at + 1:].strip()
        return head

    def declaration(self, head, names, owner, is_public):
        name = re.match(r"[^=(]*?(?<![.\w])([~\w]+) ?\(", head)
        if not is_public or name is None or re.search(r"\boperator\b", head):
            return
        if re.match(r"(using|typedef|friend|static_assert|return|enum|extern template)\b", head):
            return
        is_copy = owner is not None and re.search(
            rf"\b{owner} ?\((const )?{owner} ?&&?[^,]*\)", head)
        if name[1].startswith("~") or re.search(r"= delete$", head) or is_copy:
            return
        qualified = "::".join(n for n in names if n not in ("cdprep", "")) + "::" + name[1]
        self.found.append(re.sub(r"^cdprep::", "", qualified.lstrip(":")))


def questions_of_cpp():
    """{header: [function]}; "x3" follows the name of three overloads."""
    found = {}
    for header in sorted((INCLUDE / "cdprep").rglob("*.h")):
        name = str(header.relative_to(INCLUDE))
        if name.startswith("cdprep/c/") or name == "cdprep/cdprep.h":
            continue
        counts = collections.Counter(Scopes(header.read_text()).found)
        if counts:
            found[name] = [each if count == 1 else f"{each} x{count}"
                           for each, count in counts.items()]
    return found


# --- The table ------------------------------------------------------------------------------------


class Answers:
    """c_api_questions.txt."""

    def __init__(self):
        self.reasons = {}  # name: sentence
        self.headers = {}  # pattern: reason
        self.questions = {}  # function of C++: (functions of C, reason or None)
        self.c_only = {}  # function of C: reason
        for line in QUESTIONS.read_text().splitlines():
            line = line.strip()
            if not line or line.startswith("#"):
                continue
            left, right = (each.strip() for each in line.split(": ", 1))
            kind, _, name = left.rpartition(" ")
            if kind == "reason":
                self.reasons[name] = right
            elif kind == "header":
                self.headers[name] = right.removeprefix("- ")
            elif kind == "only":
                self.c_only[name] = right.removeprefix("- ")
            elif right.startswith("- "):
                self.questions[left] = ([], right[2:])
            else:
                self.questions[left] = (right.split(), None)

    def reason_of_header(self, header):
        for pattern, reason in self.headers.items():
            if fnmatch.fnmatch(header, pattern):
                return pattern, reason
        return None, None


def compare(cpp, c, answers):
    """Returns the rows of the table by header, and what is wrong."""
    wrong, rows, used, called = [], {}, set(), set()
    for header, functions in cpp.items():
        pattern, reason = answers.reason_of_header(header)
        for function in functions:
            if function in answers.questions:
                of_c, why = answers.questions[function]
                used.add(function)
            elif reason is not None:
                of_c, why = [], reason
                used.add(pattern)
            else:
                wrong.append(f"{header}: {function}() has no function of C, and no reason")
                continue
            called |= set(of_c)
            rows.setdefault(header, []).append((function, of_c, why))
    for name in set(answers.questions) | set(answers.headers):
        if name not in used:
            wrong.append(f"{QUESTIONS.name}: {name} names no function of the public headers of C++")
    reasons = {why for _, why in answers.questions.values() if why}
    reasons |= set(answers.headers.values()) | set(answers.c_only.values())
    for reason in sorted(reasons ^ set(answers.reasons)):
        wrong.append(f"{QUESTIONS.name}: the reason '{reason}' is " +
                     ("not explained" if reason in reasons else "never given"))
    called |= set(answers.c_only)
    for name in sorted(called - set(c.functions)):
        wrong.append(f"{QUESTIONS.name}: {name}() is in no header of C")
    for name in sorted(set(c.functions) - called):
        if not name.endswith("_init"):
            wrong.append(f"{c.functions[name][2]}: {name}() is in no row; add it to a question, or "
                         "as 'only'")
    return rows, sorted(wrong)


def table_of(rows, answers, c):
    """The text between BEGIN and END of the page."""
    lines = ["", "| reason | why there is no function in C |", "| --- | --- |"]
    lines += [f"| {name} | {text} |" for name, text in answers.reasons.items()]
    whole = [header for header, functions in rows.items()
             if not any(function in answers.questions for function, _, _ in functions)]
    lines += ["", "### Whole headers without functions in C", "", "| header | reason |",
              "| --- | --- |"]
    lines += [f"| {header} | {answers.reason_of_header(header)[1]} |" for header in whole]
    for header, functions in rows.items():
        if header in whole:
            continue
        lines += ["", f"### {header}", "", "| C++ | C |", "| --- | --- |"]
        for function, of_c, why in functions:
            cell = ", ".join(f"`{name}`" for name in of_c) if of_c else why
            lines.append(f"| `{function}` | {cell} |")
    lines += ["", "### Only in C", "", "| C | reason |", "| --- | --- |"]
    lines += [f"| `{name}` | {why} |" for name, why in answers.c_only.items()]
    lines += [f"| all functions `cdprep_..._init` ({sum(n.endswith('_init') for n in c.functions)})"
              " | they make input structs valid |", ""]
    return "\n".join(lines) + "\n"


def page_with(table):
    text = PAGE.read_text()
    begin, end = text.index(BEGIN) + len(BEGIN), text.index(END)
    return text[:begin] + table + text[end:]


# --- The list -------------------------------------------------------------------------------------


def moved(old, new):
    """Returns what differs between two lists, by name."""
    def by_name(lines):
        entries = {}
        for line in lines:
            entry = re.fullmatch(r"CDPREP_(\w+)\((.*)\)", line)
            if entry:
                parts = entry[2].split(", ", 2 if entry[1] == "FIELD" else 1)
                entries[(entry[1].lower(), ".".join(parts[:-1]))] = parts[-1]
        return entries
    before, after = by_name(old), by_name(new)
    text = []
    for (kind, name), value in after.items():
        if (kind, name) not in before:
            text.append(f"new {kind} {name}: {value}")
        elif before[kind, name] != value:
            bits = " (with 64, 32 bits)" if kind in ("struct", "field") else ""
            text.append(f"{kind} {name}: was {before[kind, name]}, is {value}{bits}")
    text += [f"{kind} {name} is gone" for kind, name in before if (kind, name) not in after]
    return text or ["only the order or the first lines differ"]


def exported(nm, library):
    """The names of C that a library defines for others."""
    dynamic = ["-D"] if re.search(r"\.so(\.|$)|\.dylib$", library) else []
    out = subprocess.run([nm, *dynamic, "-g", "--defined-only", library], check=True,
                         capture_output=True, text=True).stdout
    return set(re.findall(r"\b[TWV] _?(cdprep_\w+)$", out, re.M))


def check_exports(nm, libraries, c):
    found = set().union(*(exported(nm, library) for library in libraries))
    wrong = [f"{name}() is declared, but no library defines it" for name in set(c.functions) - found]
    wrong += [f"{name} is exported, but no header declares it" for name in found - set(c.functions)]
    return sorted(wrong)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--update", action="store_true", help="write the table and the list")
    parser.add_argument("--nm", nargs="+", metavar=("NM", "LIBRARY"),
                        help="compare the names that these libraries export")
    options = parser.parse_args()
    c, answers = CApi(), Answers()
    cpp = questions_of_cpp()
    rows, wrong = compare(cpp, c, answers)
    page = page_with(table_of(rows, answers, c))
    lines = list(c.list())
    if options.update:
        PAGE.write_text(page)
        LIST.write_text("\n".join(lines) + "\n")
    if PAGE.read_text() != page:
        wrong.append("docs/C_API.md is stale: run tests/check_c_api.py --update")
    old = LIST.read_text().splitlines() if LIST.exists() else []
    if old != lines:
        wrong += moved(old, lines)
        wrong.append("c_abi.inc: if this is meant, run tests/check_c_api.py --update, and say so in "
                     "CHANGELOG.md")
    if options.nm:
        wrong += check_exports(options.nm[0], options.nm[1:], c)
    for header, functions in rows.items():
        for function, of_c, why in functions:
            print(f"{header}: {function}: {', '.join(of_c) if of_c else '- ' + why}")
    count = sum(len(functions) for functions in cpp.values())
    in_c = sum(1 for functions in rows.values() for row in functions if row[1])
    print(f"{count} functions of C++ in {len(cpp)} headers: {in_c} are in C, "
          f"{count - in_c} have a reason. {len(c.functions)} functions and {len(c.structs)} structs "
          "of C.")
    for line in wrong:
        print(line, file=sys.stderr)
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
