#!/usr/bin/python3
"""Checks the layers: includes point down only, libraries stay in their layer, sources are paired; and the sizes.

Usage: tools/check_layers.py [ROOT]. Prints file:line: message for each problem; exit 1 if any.
What is larger than allowed stands in tools/check_layers.txt, which may only become shorter.
"""
import re
import signal
import sys
from pathlib import Path

sys.dont_write_bytecode = True

from cpp_functions import functions  # noqa: E402

BASE = ("core", "files", "image", "particles", "material", "scene", "grid")  # each may include those before it
MAY_INCLUDE = {layer: set(BASE[:i]) for i, layer in enumerate(BASE)}
MAY_INCLUDE |= {
    "sample": set(BASE),
    "output": set(BASE),
    "morphology": {"core"},  # measures any pixel map, knows no solver type
    "transfer": set(BASE),
    "physics": {*BASE, "transfer"},
    "solver": {*BASE, "sample", "output", "transfer", "physics"},  # the step
    "run": {*BASE, "sample", "output", "morphology", "transfer", "physics", "solver"},  # all around it
}
MAY_INCLUDE["app"] = set(MAY_INCLUDE) - {"app"}

LIBRARIES = (  # header of a library, the paths that may include it, their name for the message
    (r"toml\+\+/|toml\.hpp", r"src/scene/", "src/scene"),
    (r"hdf5|H5[A-Z]\w*\.h|H5public\.h", r"(src|include/poreshock)/files/", "the files layer"),
    (r"metis\.h", r"src/grid/partition\.cpp$", "src/grid/partition.cpp"),
    (r"CLI/", r"(src|include/poreshock)/app/", "the app layer"),
)
TOP_LEVEL = {"CMakeLists.txt", "src", "include", "input", "tests", "jobscripts", "tools", "README.md"}
NOT_OURS = {"build", "output"}  # made by tools/build and tools/run
LIMITS = {"body": 40, "arguments": 7, "file": 300, "unpaired": 0}  # lines, of a function, lines, sources without a header
STANDING = "tools/check_layers.txt"
INCLUDE = re.compile(r'\s*#\s*include\s*([<"])([^>"]+)[>"]')


def check_include(layer, place, file, quoted, target):
    """The problem with one include of `place` (relative to the root), or None."""
    ours = re.match(r"poreshock/(\w+)/", target)
    if ours and ours[1] not in MAY_INCLUDE:
        return f"includes {target}: there is no layer '{ours[1]}'"
    if ours and ours[1] != layer and ours[1] not in MAY_INCLUDE[layer]:
        allowed = ", ".join(sorted(MAY_INCLUDE[layer])) or "no other layer"
        return f"layer '{layer}' includes {target}; it may include {allowed}"
    if quoted and not ours and not (file.parent / target).resolve().is_relative_to(file.parent.resolve()):
        return f"includes {target}; a private header is included from its own folder only"
    for header, where, name in LIBRARIES:
        if re.match(header, target) and not re.match(where, place):
            return f"includes {target}; only {name} may"
    return None


def check_file(root, tree, file):
    """Problems of one header or source as 'file:line: message'."""
    place = file.relative_to(root).as_posix()
    parts = file.relative_to(root / tree).parts
    if len(parts) < 2 or parts[0] not in MAY_INCLUDE:
        yield f"{place}:1: lies in no layer; the layers are {', '.join(MAY_INCLUDE)}"
        return
    own = parts[0] == "app" or file.suffix == ".hpp"
    for number, line in enumerate(file.read_text().splitlines(), 1):
        found = INCLUDE.match(line)
        problem = found and check_include(parts[0], place, file, found[1] == '"', found[2])
        if problem:
            yield f"{place}:{number}: {problem}"
        own = own or found and (found[2].startswith(f"poreshock/{parts[0]}/") or found[1] == '"' and "/" not in found[2])
    if not own:
        yield f"{place}:1: includes no header of its layer, so nothing declares what it defines"
    elsewhere = list((root / "include/poreshock").glob(f"*/{file.stem}.hpp"))
    if file.suffix == ".cpp" and elsewhere and parts[0] not in [header.parent.name for header in elsewhere]:
        yield f"{place}:1: its header is {elsewhere[0].relative_to(root)}; a pair lies in one layer"


def sizes_of_functions(root):
    """(kind, name), place, size and text of the body and the arguments of every function of the program."""
    for tree in ("include/poreshock", "src"):
        for file in sorted((root / tree).rglob("*.[ch]pp")):
            path = file.relative_to(root).as_posix()
            for line, name, arguments, body in functions(file.read_text()):
                key, place = f"{path}:{name}", f"{path}:{line}"
                yield ("body", key), place, body, f"'{name}' has {body} lines"
                yield ("arguments", key), place, arguments, f"'{name}' takes {arguments} arguments"


def is_named(root, source):
    """True when a header of the source's layer says in a comment that it defines a part of it."""
    headers = [file for tree in ("include/poreshock", "src") for file in (root / tree / source.parts[1]).glob("*.hpp")]
    return any(re.search(rf"^//.*\b{source.name}\b", header.read_text(), re.M) for header in headers)


def sizes_of_files(root):
    """The same of every file of code, and of sources that lack their header."""
    for file in sorted(file for tree in ("include", "src", "tests", "tools") for file in (root / tree).rglob("*")):
        path = file.relative_to(root).as_posix()
        if file.suffix not in (".cpp", ".hpp", ".py") and (file.suffix or not path.startswith("tools/")) or file.is_dir():
            continue
        lines = file.read_text().count("\n")
        yield ("file", path), f"{path}:{LIMITS['file'] + 1}", lines, f"has {lines} lines"
        header = Path(path).with_suffix(".hpp")
        pair = (header, "include/poreshock" / header.relative_to("src")) if header.is_relative_to("src") else ()
        if file.suffix == ".cpp" and pair and path != "src/app/main.cpp":
            lacks = not any((root / name).is_file() for name in pair) and not is_named(root, Path(path))
            yield ("unpaired", path), f"{path}:1", int(lacks), f"has no header, {pair[1]} or {pair[0]}, and no header of its layer names it"


def read_standing(file):
    """The size that is let stand, and its line, of each (kind, name)."""
    entries = {}
    for number, line in enumerate(file.read_text().splitlines() if file.is_file() else (), 1):
        entry = re.fullmatch(r"(\w+) (\S+) (\d+)", line)
        if entry or not line.startswith("#"):
            entries[(entry[1], entry[2]) if entry else (line, "")] = (int(entry[3]) if entry else 0, number)
    return entries


def check_sizes(root):
    """Problems of sizes beyond their limits, and of entries of the list that nothing needs any more."""
    standing, needed = read_standing(root / STANDING), set()
    for sizes in (sizes_of_functions(root), sizes_of_files(root)):
        for key, place, size, text in sizes:
            if size <= LIMITS[key[0]]:
                continue
            needed.add(key)
            allowed = max(LIMITS[key[0]], standing.get(key, (0, 0))[0])
            if size > allowed:
                yield f"{place}: {text}" + (f"; at most {allowed} are allowed" if allowed else "")
    for kind, name in sorted(standing.keys() - needed):
        yield f"{STANDING}:{standing[kind, name][1]}: '{kind} {name}' is beyond no limit; strike the line"


def problems(root):
    """All problems below `root`, in order of path."""
    for entry in sorted(root.iterdir()):
        if entry.name not in TOP_LEVEL | NOT_OURS and not entry.name.startswith("."):
            yield f"{entry.name}:1: does not belong here; the top level holds {', '.join(sorted(TOP_LEVEL))}"
    for tree in ("include/poreshock", "src"):
        for file in sorted((root / tree).rglob("*.[ch]pp")):
            yield from check_file(root, tree, file)
    yield from check_sizes(root)


if __name__ == "__main__":
    signal.signal(signal.SIGPIPE, signal.SIG_DFL)  # a reader that stops early, as head does, is no fault
    found = list(problems(Path(sys.argv[1] if len(sys.argv) > 1 else Path(__file__).parent.parent).resolve()))
    print("\n".join(found), end="\n" if found else "")
    sys.exit(1 if found else 0)
