"""Just enough C++ to find includes and function bodies: no parser, braces and what precedes them."""

import re
from dataclasses import dataclass

_TOKEN = re.compile(
    r'//[^\n]*'
    r'|/\*.*?\*/'
    r'|(?:u8|[uUL])?R"(?P<delimiter>[^()\\\s]{0,16})\(.*?\)(?P=delimiter)"'
    r'|"(?:\\.|[^"\\\n])*"'
    r"|(?<![0-9A-Za-z_])'(?:\\.|[^'\\\n])+'",
    re.DOTALL)
_DIRECTIVE = re.compile(r"^[ \t]*#(?:[^\n]*\\\n)*[^\n]*", re.MULTILINE)
_INCLUDE = re.compile(r'^\s*#\s*include\s*[<"]([^>"]+)[>"]')
_SCOPE = re.compile(r"\s*(?:template\s*)?(?:namespace|class|struct|union|enum)\b")
_LAMBDA = re.compile(r"(?:^|[=,])\s*\[[^\]]*\]\s*(?:@[^=]*)?$")
_MEMBER_INITIALIZER = re.compile(r"@[^=]*(?<!:):(?!:).*\w\s*$", re.DOTALL)
_NAME = re.compile(r"([~\w:]+|operator\s*\S+?)\s*@")


def _blank(match):
    return re.sub(r"[^\n]", " ", match.group(0))


def code_of(text):
    """`text` with comments and literals blanked; line and column of the rest unchanged."""
    return _TOKEN.sub(_blank, text)


def includes_of(text):
    """(line, path) of every #include."""
    original = text.splitlines()
    for number, line in enumerate(code_of(text).splitlines(), 1):
        if re.match(r"\s*#\s*include\b", line):
            match = _INCLUDE.match(original[number - 1])
            if match:
                yield number, match.group(1)


@dataclass(frozen=True)
class Function:
    name: str
    line: int  # where its declaration starts
    lines: int  # from there to the closing brace


def _flat(head):
    """`head` with operators' symbols and template arguments removed, (...) and {...} as @."""
    head = re.sub(r"\boperator\s*(?:\(\)|[^\s\w(]+)", "operator", head)
    for brackets, stand_in in ((r"\([^()]*\)|\{[^{}]*\}", "@"), (r"<[^<>]*>", "")):
        previous = None
        while previous != head:
            previous, head = head, re.sub(brackets, stand_in, head)
    return head


def _opens_function(flat):
    if _LAMBDA.search(flat):
        return True
    return "@" in flat and "=" not in flat and not _SCOPE.match(flat)


def _matching_brace(code, start):
    depth = 0
    for match in re.compile(r"[{}]").finditer(code, start):
        depth += 1 if match.group() == "{" else -1
        if depth == 0:
            return match.start()
    return len(code) - 1


def functions_of(text):
    """Every outermost function; a lambda inside one counts as part of it."""
    code = _DIRECTIVE.sub(_blank, code_of(text))
    functions = []
    start = position = 0  # the head under study begins at `start`
    breaks = re.compile(r"[;{}]|\b(?:public|private|protected)\s*:")
    while match := breaks.search(code, position):
        head = code[start:match.start()]
        position = match.end()
        if head.count("(") > head.count(")"):  # a default argument or a macro's argument
            if match.group() == "{":
                position = _matching_brace(code, match.start()) + 1
            continue
        if match.group() == "{":
            flat = _flat(head)
            if _MEMBER_INITIALIZER.search(flat) and not _SCOPE.match(flat):
                position = _matching_brace(code, match.start()) + 1
                continue
            if _opens_function(flat):
                end = _matching_brace(code, match.start())
                functions.append(_function(code, start, head, flat, end))
                position = end + 1
        start = position
    return functions


def _function(code, start, head, flat, end):
    first = start + len(head) - len(head.lstrip())
    name = _NAME.search(flat)
    return Function(name.group(1) if name else "lambda", code.count("\n", 0, first) + 1,
                    code.count("\n", first, end) + 1)
