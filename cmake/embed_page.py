"""Puts the sources of the HTML report into one page and writes it as a C++ header.

usage: embed_page.py PAGE_FOLDER VEGA_FOLDER HEADER

template.html names what goes where, one directive a line: @style FILE..., @vega MODULE..., @script FILE... The scripts are
ES modules, joined into one in the order given: their imports and exports go, so top-level names are unique. Vega comes as
Debian packages it, one CommonJS module a file. @title and @data are left for the program.
"""
import pathlib
import re
import sys

IMPORT = re.compile(r'^import \{[^}]*\} from "[^"]+";\n', re.MULTILINE)
EXPORT = re.compile(r"^export (?=(async )?(function|const|class) )", re.MULTILINE)
LEFT_FOR_THE_PROGRAM = ("title", "data")


def scripts(folder, names):
    parts = []
    for name in names:
        text = EXPORT.sub("", IMPORT.sub("", (folder / name).read_text()))
        if re.search(r"^(import|export) ", text, re.MULTILINE):
            sys.exit(f"embed_page: {name} has an import or export that is no single statement at the start of a line")
        parts.append(f"// --- {name}\n{text}")
    return "\n".join(parts)


def vega_modules(folder, names):
    parts = []
    for name in names:
        text = re.sub(r"//# sourceMappingURL=.*", "", (folder / f"{name}.min.js").read_text()).strip()
        parts.append(f'vegaSources["{name}"] = function (exports, module, require) {{\n{text}\n}};')
    return "\n".join(parts)


def expand(page, vega, used):
    lines = []
    for line in (page / "template.html").read_text().splitlines():
        directive = re.match(r"\s*@(\w+)\s*(.*)", line)
        if not directive or directive[1] in LEFT_FOR_THE_PROGRAM:
            lines.append(line)
            continue
        names = directive[2].split()
        if directive[1] == "vega":
            used += [vega / f"{name}.min.js" for name in names]
            text = vega_modules(vega, names)
        else:
            used += [page / name for name in names]
            text = scripts(page, names) if directive[1] == "script" else "".join((page / n).read_text() for n in names)
        if "</script" in text or "<!--" in text:
            sys.exit(f"embed_page: '</script' and '<!--' would end the script they stand in: {' '.join(names)}")
        lines.append(text)
    return "\n".join(lines) + "\n"


def main():
    page, vega, header = (pathlib.Path(argument) for argument in sys.argv[1:4])
    used = [page / "template.html"]
    text = expand(page, vega, used)
    if ')page"' in text:
        sys.exit("embed_page: the page may not have what ends the C++ literal")
    # String literals are limited to 64 KiB by the standard; adjacent raw literals are joined by the compiler.
    chunks = "\n".join(f'R"page({text[i:i + 16000]})page"' for i in range(0, len(text), 16000))
    header.parent.mkdir(parents=True, exist_ok=True)
    header.write_text(f"#pragma once\nnamespace pb {{\ninline constexpr char kPageSource[] =\n{chunks};\n}}  // namespace pb\n")
    pathlib.Path(f"{header}.d").write_text(f"{header}: {' '.join(map(str, used))}\n")


main()
