#!/usr/bin/env python3
"""What the tests are worth: changes one operator or constant of a body (include/gonio/*/impl/*.ipp), links the module's
test with the changed body, runs it, and counts the changes that the test sees.

    python3 tests/mutation/run.py [--seed 1] [--count 100] [--build build/test] [--modules solve table ...] [--jobs 1]
                                  [--at solve/impl/kkt.ipp:44 ...]

The tests must have been built, as `cmake -P cmake/test.cmake` does, and no source may change while this runs. Only the
changed body is compiled: its object stands before the library's, so that the linker takes its functions. Calls within
the library's own object still reach the unchanged ones: what survives so is tried again with all bodies of its source
compiled. A change that does not compile, or does not change the object, is drawn again. A test fails that takes three
times as long as it did, and 20 s more. Survivors are printed as a table. --at tries all changes of these lines."""

import argparse
import concurrent.futures
import pathlib
import random
import re
import shlex
import subprocess
import sys
import threading
import time

SOURCE = pathlib.Path(__file__).resolve().parents[2]
HEADERS = SOURCE / "include"
MODULES = ["core", "solve", "table", "metric", "basis", "estimate", "robust", "interpolate", "conformity", "texels",
           "design", "model", "capture", "render", "evaluate", "io"]
SWAPS = [(" < ", " <= "), (" <= ", " < "), (" > ", " >= "), (" >= ", " > "), (" == ", " != "), (" != ", " == "),
         (" + ", " - "), (" - ", " + "), (" * ", " / "), (" / ", " * "), (" += ", " -= "), (" -= ", " += "),
         (" && ", " || "), (" || ", " && "), ("std::min(", "std::max("), ("std::max(", "std::min("),
         ("true", "false"), ("false", "true")]
NUMBER = re.compile(r"(?<![\w.\"'])(\d+\.\d+(?:e-?\d+)?|\d+e-\d+|\d+)(?![\w.\"'])")
IS_CODE = re.compile(r"^(?!\s*(//|#|using |template|static_assert|namespace))")


def run(command, **options):
    return subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, errors="replace",
                          **options)


def without_texts(line):
    """The line with strings, characters and comments blanked, so that columns stay."""
    blank = lambda found: " " * len(found.group())
    return re.sub(r"//.*$", blank, re.sub(r"\"(\\.|[^\"\\])*\"|'(\\.|[^'\\])'", blank, line))


def changes_of(path):
    """All (line number, column, old, new) of a file."""
    found = []
    for number, line in enumerate(path.read_text().split("\n")):
        if not IS_CODE.match(line):
            continue
        code = without_texts(line)
        for old, new in SWAPS:
            found += [(number, at.start(), old, new) for at in re.finditer(re.escape(old), code)]
        for at in NUMBER.finditer(code):
            old = at.group()
            found.append((number, at.start(), old, str(int(old) + 1) if old.isdigit() else repr(1.5 * float(old))))
    return found


def changed_text(path, change):
    """The text with the change, and the changed line."""
    number, column, old, new = change
    lines = path.read_text().split("\n")
    line = lines[number]
    assert line[column:column + len(old)] == old
    lines[number] = line[:column] + new + line[column + len(old):]
    return "\n".join(lines), lines[number].strip()


class tester:
    """The tests of one build, and what was measured of them."""

    def __init__(self, build):
        self.build, self.lock, self.originals, self.seconds, self.whole = build, threading.Lock(), {}, {}, set()

    def commands(self, target):
        return [shlex.split(line) for line in run(["ninja", "-t", "commands", target], cwd=self.build).stdout.split("\n")]

    def prepare(self, modules):
        """Sorts the bodies by the source that includes them, and keeps the commands that compile and link."""
        self.sources, self.link = {}, {}
        for module in modules:
            commands = self.commands(f"test_{module}")
            self.link[module] = next(command for command in commands if f"tests/test_{module}" in command)
            for command in commands:
                if not command or not command[-1].endswith(".cpp") or pathlib.Path(command[-1]).parent != SOURCE / "src":
                    continue
                for body in re.findall(r"#include <(gonio/.*/impl/.*[.]ipp)>", pathlib.Path(command[-1]).read_text()):
                    self.sources[HEADERS / body] = command

    @staticmethod
    def header_of(body):
        header = body.replace("/impl/", "/").replace(".ipp", ".hpp")
        return header if (HEADERS / header).exists() else body

    def object_of(self, path, text, folder, whole):
        """The object of the body alone, or of its whole source, or None if it does not compile."""
        command = self.sources[path]
        body = path.relative_to(HEADERS)
        overlay = folder / "include" / body
        overlay.parent.mkdir(parents=True, exist_ok=True)
        overlay.write_text(text)
        # The other bodies come from the library, but for templates, which the source may instantiate.
        others = pathlib.Path(command[-1]).read_text()
        if not whole:
            alone = lambda found: found[0] if found[1] == str(body) else f"#include <{self.header_of(found[1])}>"
            others = re.sub(r"#include <(gonio/.*/impl/.*[.]ipp)>", alone, others)
        (folder / "source.cpp").write_text(others)
        compiled = folder / "object.o"
        compiler = [word for word in command[:-1] if "ccache" not in word.lower()]
        compiler = compiler[compiler.index(next(word for word in compiler if re.search(r"g\+\+|clang", word))):]
        for flag in ("-MT", "-MF"):
            at = compiler.index(flag)
            del compiler[at:at + 2]
        compiler[compiler.index("-o") + 1] = str(compiled)
        compiler = [word for word in compiler if word not in ("-MD", "-Werror")]
        compiler.insert(1, f"-I{folder / 'include'}")
        failed = run([*compiler, str(folder / "source.cpp")], cwd=self.build).returncode != 0
        overlay.unlink()
        return None if failed else compiled.read_bytes()

    def passes(self, module, program, folder, arguments, limit):
        start = time.monotonic()
        try:
            good = run([str(program), "--abort-after=1", *arguments], timeout=limit, cwd=folder,
                       env={"RC_PARAMS": "seed=1", "PATH": "/usr/bin:/bin"}).returncode == 0
        except subprocess.TimeoutExpired:
            good = False
        return good, time.monotonic() - start

    def usual_seconds(self, module, arguments, folder):
        """How long the unchanged test takes; it must pass."""
        with self.lock:
            key = (module, *arguments)
            if key not in self.seconds:
                good, self.seconds[key] = self.passes(module, self.build / "tests" / f"test_{module}", folder, arguments,
                                                      3600)
                if not good:
                    sys.exit(f"test_{module} {' '.join(arguments)} fails without any change")
            return self.seconds[key]

    def passes_with_object(self, module, path, folder):
        """Whether the module's test passes with the object before the library's; None if they do not link."""
        program = folder / f"test_{module}"
        command = [word for word in self.link[module] if word not in (":", "&&")]
        command[command.index("-o") + 1] = str(program)
        first = next(index for index, word in enumerate(command) if word.endswith(".o"))
        command[first:first] = ["-Wl,--allow-multiple-definition", str(folder / "object.o")]
        if run(command, cwd=self.build).returncode != 0:
            return None
        # The file of tests that bears its name first, then all.
        for arguments in ([f"--source-file=*/{path.stem}.cpp"], []):
            usual = self.usual_seconds(module, arguments, folder)
            if not self.passes(module, program, folder, arguments, 3.0 * usual + 20.0)[0]:
                return False
        return True

    def survives(self, module, path, change, folder):
        """Whether the module's test passes with the change; None if the change is none."""
        text, line = changed_text(path, change)
        with self.lock:
            if path not in self.originals:
                self.originals[path] = self.object_of(path, path.read_text(), folder, False)
                if self.originals[path] is None:
                    self.whole.add(path)
                    self.originals[path] = self.object_of(path, path.read_text(), folder, True)
        first_whole = path in self.whole
        changed = self.object_of(path, text, folder, first_whole)
        if changed is None or changed == self.originals[path]:
            return None, line
        survived = self.passes_with_object(module, path, folder)
        # Others of its source, which the compiler may have inlined it into, still take the library's function.
        if survived and not first_whole and self.object_of(path, text, folder, True) is not None:
            survived = self.passes_with_object(module, path, folder)
        return survived, line


def main():
    options = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    options.add_argument("--seed", type=int, default=1)
    options.add_argument("--count", type=int, default=100)
    options.add_argument("--jobs", type=int, default=1)
    options.add_argument("--build", type=pathlib.Path, default=SOURCE / "build" / "test")
    options.add_argument("--modules", nargs="+", default=MODULES)
    options.add_argument("--at", nargs="+", help="FILE:LINE below include/gonio")
    given = options.parse_args()
    tests = tester(given.build.resolve())
    tests.prepare(given.modules)
    draws = [(module, path, change) for module in given.modules
             for path in sorted((HEADERS / "gonio" / module).rglob("*.ipp")) if path in tests.sources
             for change in changes_of(path)]
    random.Random(given.seed).shuffle(draws)
    place_of = lambda path, change: f"{path.relative_to(HEADERS / 'gonio')}:{change[0] + 1}"
    if given.at:
        draws = [draw for draw in draws if place_of(*draw[1:]) in given.at]
    counts, tried = {True: 0, False: 0}, iter(draws)

    def work(number):
        folder = given.build.resolve() / "mutation" / str(number)
        folder.mkdir(parents=True, exist_ok=True)
        while True:
            with tests.lock:
                draw = next(tried, None)
                if draw is None or counts[True] + counts[False] >= given.count:
                    return
            module, path, change = draw
            survived, line = tests.survives(module, path, change, folder)
            if survived is None:
                continue
            with tests.lock:
                counts[survived] += 1
                if survived:
                    print(f"| `{place_of(path, change)}` | `{change[2].strip()}` -> `{change[3].strip()}` | `{line}` |", flush=True)

    with concurrent.futures.ThreadPoolExecutor(given.jobs) as pool:
        list(pool.map(work, range(given.jobs)))
    print(f"\n{counts[False]} of {counts[True] + counts[False]} changes were seen by the module's own test "
          f"(seed {given.seed}); {len(draws)} are possible")


if __name__ == "__main__":
    main()
