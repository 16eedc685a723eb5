#!/usr/bin/env python3
"""Makes the manual pages from their prose, the programs' own help, and the comments of the schema.

usage: generate.py --hapticd FILE --hapticctl FILE --haptic-bridge FILE --haptic-view FILE [--check]

man/source/PAGE holds the prose of each page in troff. A line of it that begins with @ is replaced:
  @verbs PROGRAM           each verb of hapticd or hapticctl with its arguments and options, from --help
  @options PROGRAM         each option of a program without verbs, from --help
  @messages FILE NAME...   the fields of these messages of proto/haptic/v1/FILE, with those inside, from its comments
  @header NAME SECTION     the title line, with the program's version

Without --check the pages in man/ are written; with it, exit code 1 tells that they differ from what would be.
"""

import argparse
import re
import subprocess
import sys
from pathlib import Path

MAN = Path(__file__).resolve().parent
PROTO = MAN.parent / "proto" / "haptic" / "v1"


def troff(text):
    """Text as troff shows it unchanged."""
    text = text.replace("\\", "\\e").replace("-", "\\-")
    return re.sub(r"^([.'])", r"\\&\1", text, flags=re.MULTILINE)


# --- the programs' help -----------------------------------------------------------------------------------


def run(program, *arguments):
    return subprocess.run([program, *arguments], check=True, capture_output=True, text=True).stdout


def entries(help_text, section):
    """The (name, text) pairs of a section of CLI11's help; wrapped lines are joined."""
    pairs, inside = [], False
    for line in help_text.splitlines():
        if not line.startswith(" "):
            inside = line == section + ":" if line else inside and not pairs
            continue
        if not inside:
            continue
        name, _, text = line.strip().partition("  ")
        if line.startswith("   "):
            pairs[-1][1] = (pairs[-1][1] + " " + line.strip()).strip()
        else:
            pairs.append([name, text.strip()])
    return pairs


def footer(help_text):
    """What stands after the options, as it is."""
    blocks = help_text.rstrip().split("\n\n")
    return "" if re.match(r"[A-Z]\w+:\n", blocks[-1]) or "Usage:" in blocks[-1] else blocks[-1].strip("\n")


def is_common(program, option):
    """Whether a page tells of the option once for all verbs."""
    common = {"-h,--help"}
    if Path(program).name == "hapticctl":
        common |= {"--version", "--json", "--socket", "--server", "--certificate", "--key", "--authority"}
    return option.split()[0] in common


def option_lines(name, meaning):
    """One option, of the name and the text that CLI11's help has for it."""
    name = name.replace(" REQUIRED", "").replace(" ...", "")
    name = re.sub(r" (Needs|Excludes):.*| x \d+.*| \(Env:.*", "", name)
    meaning = re.sub(r" ?(Needs|Excludes):( --?[\w-]+)+", "", " " + meaning).strip()
    return [".TP", "\\fB" + troff(name).replace(" ", "\\fR ", 1) + ("" if " " in name else "\\fR"), troff(meaning)]


def argument_lines(name, meaning):
    """One argument that is told by its place: its name, and what it may be where the help lists that."""
    word, *kind = re.sub(r" REQUIRED| \.\.\.", "", name).split()
    choices = " " + " ".join(kind) if "|" in "".join(kind) else ""
    return [".TP", f"\\fI{troff(word)}\\fR{troff(choices)}", troff(meaning)]


def options_page(program):
    return [
        line
        for name, meaning in entries(run(program, "--help"), "Options")
        if not name.startswith(("-h,--help", "--version"))
        for line in option_lines(name, meaning)
    ]


def verb_page(program, path, text, common_footer):
    """One verb, and those below it."""
    help_text = run(program, *path, "--help")
    lines = []
    below = entries(help_text, "Subcommands")
    if not below and path:
        arguments = " ".join(
            name.split()[0] if "REQUIRED" in name else f"[{name.split()[0]}]"
            for name, _ in entries(help_text, "Positionals")
        )
        lines += [".TP", f"\\fB{troff(' '.join(path))}\\fR {troff(arguments)}".rstrip(), troff(text[:1].upper() + text[1:]) + "."]
        told = [(name, meaning) for name, meaning in entries(help_text, "Positionals") if meaning]
        options = [pair for pair in entries(help_text, "Options") if not is_common(program, pair[0])]
        if told or options:
            lines.append(".RS")
        for name, meaning in told:
            lines += argument_lines(name, meaning)
        for name, meaning in options:
            lines += option_lines(name, meaning)
        if told or options:
            lines.append(".RE")
    for name, meaning in below:
        lines += verb_page(program, [*path, name], meaning, common_footer)
    notes = footer(help_text)
    if path and notes and notes != common_footer:
        lines += [".RS", ".PP", ".nf", troff(notes), ".fi", ".RE"]
    return lines


def verbs(program):
    return verb_page(program, [], "", footer(run(program, "--help")))


# --- the schema's comments --------------------------------------------------------------------------------

FIELD = re.compile(r"^\s*(optional |repeated )?([\w.]+) (\w+) = \d+;\s*(?://\s*(.*))?$")
VALUE = re.compile(r"^\s*(\w+) = (\d+);\s*(?://\s*(.*))?$")
OPENING = re.compile(r"^\s*(message|enum|oneof) (\w+) \{(.*)$")


class Block:
    """A message, an enum or a oneof: what is said of it, and its lines in order."""

    def __init__(self, kind, name, comment):
        self.kind, self.name, self.comment = kind, name, comment
        self.fields, self.blocks = [], []


def parse(text):
    """The top blocks of a .proto file as the project writes them: one field a line."""
    top = Block("file", "", "")
    stack, comment, last = [top], [], None
    for line in text.splitlines():
        stripped = line.strip()
        opening, field, value = OPENING.match(line), FIELD.match(line), VALUE.match(line)
        if stripped.startswith("//"):
            said = stripped[2:].strip()
            # a comment that stands right of a field's column goes on with that field's
            if last is not None and len(line) - len(line.lstrip()) > 20:
                last[3] = (last[3] + " " + said).strip()
            else:
                comment.append(said)
            continue
        last = None
        if opening:
            kind, name, rest = opening.groups()
            block = Block(kind, name, " ".join(comment))
            stack[-1].blocks.append(block)
            if "}" not in rest:
                stack.append(block)
            else:
                inner = FIELD.match(rest.split("}")[0].strip())
                if inner:
                    block.fields.append([inner.group(1) or "", inner.group(2), inner.group(3), rest.partition("//")[2].strip()])
        elif stripped == "}":
            closed = stack.pop()
            if closed.kind == "oneof":
                stack[-1].fields += closed.fields
                stack[-1].blocks.remove(closed)
        elif field and stack[-1].kind != "enum":
            label, kind, name, said = field.groups()
            said = " ".join([*comment, said or ""]).strip()
            if stack[-1].kind == "oneof":
                label = "one of "
            last = [label or "", kind, name, said]
            stack[-1].fields.append(last)
        elif value:
            last = ["", "", value.group(1), " ".join([*comment, value.group(3) or ""]).strip()]
            stack[-1].fields.append(last)
        comment = []
    return top.blocks


def sentence(text):
    return troff(text) + ("" if not text or text.endswith((".", ":")) else ".")


def message_lines(block, prefix=""):
    name = prefix + block.name
    lines = [f".SS {troff(name)}"]
    if block.comment:
        lines.append(sentence(block.comment))
    if not block.fields and not block.comment:
        lines.append("It has no fields.")
    for label, kind, field, said in block.fields:
        mark = {"repeated ": " (any number)", "one of ": " (at most one of these)", "optional ": " (may be absent)"}.get(label, "")
        lines += [".TP", f"\\fB{troff(field)}\\fR" + (f" \\fI{troff(kind)}\\fR{mark}" if kind else ""), sentence(said) or "\\&"]
    for inner in block.blocks:
        lines += message_lines(inner, name + ".")
    return lines


def messages(file, names):
    blocks = {block.name: block for block in parse((PROTO / file).read_text(encoding="utf-8"))}
    lines = []
    for name in names or blocks:
        lines += message_lines(blocks[name])
    return lines


# --- the pages --------------------------------------------------------------------------------------------


def page(source, programs):
    version = run(programs["hapticd"], "--version").split()[-1]
    lines = [".\\\" Made by man/generate.py from man/source; do not edit."]
    for line in source.read_text(encoding="utf-8").splitlines():
        if not line.startswith("@"):
            lines.append(line)
            continue
        word, *arguments = line[1:].split()
        if word == "header":
            lines.append(f'.TH {arguments[0]} {arguments[1]} "" "hapticd {version}" "hapticd manual"')
        elif word == "verbs":
            lines += verbs(programs[arguments[0]])
        elif word == "options":
            lines += options_page(programs[arguments[0]])
        elif word == "messages":
            lines += messages(arguments[0], arguments[1:])
        else:
            raise ValueError(f"{source}: no such line: {line}")
    return "\n".join(lines) + "\n"


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--hapticd", required=True)
    parser.add_argument("--hapticctl", required=True)
    parser.add_argument("--haptic-bridge", required=True)
    parser.add_argument("--haptic-view", required=True)
    parser.add_argument("--check", action="store_true")
    options = parser.parse_args()
    programs = {"hapticd": options.hapticd, "hapticctl": options.hapticctl, "haptic-bridge": options.haptic_bridge,
                "haptic-view": options.haptic_view}
    stale = []
    for source in sorted((MAN / "source").iterdir()):
        target, text = MAN / source.name, page(source, programs)
        if options.check and (not target.is_file() or target.read_text(encoding="utf-8") != text):
            stale.append(target.name)
        elif not options.check:
            target.write_text(text, encoding="utf-8")
    if stale:
        print("differ from the programs and the schema: " + ", ".join(stale) + "; cmake --build build/dev --target manual_pages makes them anew", file=sys.stderr)
    return 1 if stale else 0


if __name__ == "__main__":
    sys.exit(main())
