"""Finds the functions that C++ text defines by its brackets, in code without tricks of the preprocessor."""
import re

HIDDEN = re.compile(r"""//[^\n]*|/\*.*?\*/|R"(\w*)\(.*?\)\1"|"(?:\\.|[^"\\\n])*"|(?<![0-9A-Fa-f])'(?:\\.|[^'\\\n])*'"""
                    r"|^[ ]*#(?:[^\n]*\\\n)*[^\n]*", re.S | re.M)
SCOPE = re.compile(r"\b(?:namespace|class|struct|union)\b[^()=]*$|^\s*extern\s*$")
NAME = re.compile(r"(?:(?:\w+::)*(?:operator\s*(?:\(\)|[^\s\w(]+|[\w:]+)|~?\w+(?:<[^()]*>)?))\s*$")
NO_NAME = {"decltype", "noexcept", "requires", "alignas", "__attribute__"}


def without_text(code):
    """The code with comments, strings and directives blanked; the lines stay."""
    return HIDDEN.sub(lambda found: re.sub(r"[^\n]", " ", found[0]), code)


def closing(code, start, brackets="()[]{}"):
    """Position of what closes the bracket at `start`, or the end of the code."""
    depth = 0
    for found in re.compile("[" + re.escape(brackets) + "]").finditer(code, start):
        depth += 1 - 2 * (brackets.index(found[0]) % 2)
        if depth == 0:
            return found.start()
    return len(code)


def without_template(head):
    """The head of a definition without the parameters of a template."""
    while found := re.match(r"\s*template\s*(?=<)", head):
        head = head[closing(head, found.end(), "<>") + 1:]
    return head


def count_arguments(text):
    """Arguments in the text between the brackets of a parameter list."""
    depth, count = 0, 1
    for letter in text.replace("->", "  "):
        depth += (letter in "([{<") - (letter in ")]}>")
        count += letter == "," and depth == 0
    return count if text.strip() not in ("", "void") else 0


def signature(head):
    """Name and number of arguments of the function that the text before its `{` heads, or None."""
    head = without_template(head)
    if re.search(r"(?<![=!<>])=(?!=)", re.split(r"\boperator\b|\(", head)[0]):
        return None  # a value
    at = -1
    while (at := head.find("(", at + 1)) >= 0:
        close = closing(head, at)
        name = NAME.search(head[:at])
        call = re.match(r"\(\s*\)\s*(?=\()", head[at:])  # operator()(...)
        if name and name[0].strip() not in NO_NAME and not (name[0].strip() == "operator" and call):
            return name[0].strip(), count_arguments(head[at + 1:close])
        at = close if not call else at + call.end() - 2
    return None


def body(code, at):
    """Where the body starts and ends of a function whose first `{` is at `at`: initialisers of members come before it."""
    close = closing(code, at)
    while re.compile(r"\s*[,{]").match(code, close + 1):
        at = code.index("{", close + 1)
        close = closing(code, at)
    return at, close


def functions(code):
    """Line, name, lines of the body and number of arguments of every function that the code defines."""
    code = without_text(code)
    start = at = 0
    while found := re.compile(r"[;}(\[{]").search(code, at):
        at, head = found.start(), code[start:found.start()]
        if found[0] in "([":
            at = closing(code, at)
        elif found[0] in ";}" or SCOPE.search(without_template(head)):
            start = at + 1
        elif named := signature(head):
            first = start + len(head) - len(head.lstrip())
            at, end = body(code, at)
            yield code.count("\n", 0, first) + 1, *named, max(code.count("\n", at, end) - 1, 0)
            at, start = end, end + 1
        else:
            at = closing(code, at)
        at += 1
