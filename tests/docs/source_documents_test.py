#!/usr/bin/env python3
"""docs/source-documents.md has the rows of the script that makes it, all of the documents' rows, and names tests that exist.

usage: source_documents_test.py SOURCE_DIR
"""
import pathlib
import re
import sys
import unittest

source = pathlib.Path(sys.argv.pop())
page = (source / "docs/source-documents.md").read_text()
script = (source / "scripts/source-documents").read_text()

# What the five documents do or wish for, by their letters; see the page's titles.
DOCUMENTED = [f"{letter}{number}" for letter, count in zip("ABCDE", (21, 11, 4, 7, 5)) for number in range(1, count + 1)]


def rows_of_page():
    return [row for row in re.findall(r"^\| ([^|]+) \| [^|]+ \| .+ \|$", page, re.M) if row not in ("row", "mirrors", "---")]


def rows_of_script():
    return re.findall(r'^        \("([^"]+)",\s', script, re.M)


class SourceDocuments(unittest.TestCase):
    def test_rows_of_the_page_are_those_of_the_script(self):
        self.assertEqual([row for row in rows_of_page() if not row.isdigit()], rows_of_script())

    def test_every_row_of_the_documents_is_there(self):
        found = {row for rows in rows_of_page() for row in rows.split(", ")}
        self.assertEqual([row for row in DOCUMENTED if row not in found], [])

    def test_named_tests_exist(self):
        tests = "\n".join(path.read_text() for path in (source / "tests").rglob("*.cpp"))
        named = re.findall(r"`(\w+)\.(\w+_\w+|[A-Z]\w+)`", "\n".join(re.findall(r"tests `.*", page)))
        self.assertTrue(named)
        for suite, name in named:
            self.assertRegex(tests, rf"TEST(_F|_P)?\({suite}, {name}\)")


unittest.main()
