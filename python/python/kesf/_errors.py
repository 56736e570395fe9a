"""What goes wrong, and what a reader of a result must know."""

from __future__ import annotations

import json
from dataclasses import dataclass, field
from typing import Any

from . import _kesf


class KesfError(Exception):
    """Why there is no result: the one exception type of this package.

    Its text is ``place: code message; cure``.

    Attributes:
        code: Stable code such as ``R008``; ``kesf.explain(code)`` tells more.
        message: What is wrong.
        path: The file, where there is one.
        line: Its line, from 1, where there is one.
        column: Its column, from 1, where there is one.
        cure: What to do: what the error itself says of it, or else what ``kesf.explain(code)`` does.
        fields: The data of the message by their names; numbers are SI.
        failures: Every failure, where none of several inputs could be read.

    >>> import kesf
    >>> try:
    ...     kesf.read("nowhere.csv")
    ... except kesf.KesfError as error:
    ...     print(error.code, error.path)
    R001 nowhere.csv
    """

    def __init__(
        self,
        message: str,
        *,
        code: str = "O050",
        path: str | None = None,
        line: int | None = None,
        column: int | None = None,
        cure: str | None = None,
        fields: dict[str, Any] | None = None,
    ) -> None:
        self.code = code
        self.message = message
        self.path = path
        self.line = line
        self.column = column
        self._hint = cure
        self.fields: dict[str, Any] = fields or {}
        self.failures: tuple[Failure, ...] = ()
        place = ":".join(str(part) for part in (path, line, column) if part is not None)
        text = f"{code} {message}"
        if place:
            text = f"{place}: {text}"
        if cure:
            text = f"{text}; {cure}"
        super().__init__(text)

    @property
    def cure(self) -> str | None:
        """What to do."""
        return self._hint or _cure_of(self.code)

    @classmethod
    def _of(
        cls,
        code: str,
        message: str,
        path: str | None,
        line: int | None,
        column: int | None,
        cure: str | None,
        fields: str,
    ) -> KesfError:
        return cls(message, code=code, path=path, line=line, column=column, cure=cure, fields=json.loads(fields))

    def __reduce__(self) -> tuple[Any, ...]:
        return (
            KesfError._of,
            (self.code, self.message, self.path, self.line, self.column, self._hint, json.dumps(self.fields)),
            {"failures": self.failures},
        )


@dataclass(frozen=True)
class Finding:
    """Something that a reader of a result must know. A finding never stops the work.

    Attributes:
        code: Stable code such as ``K010``; ``kesf.explain(code)`` tells more.
        message: One sentence.
        fields: The data of the sentence by their names; numbers are SI.
        fabric: The fabric that it is about, where that is not plain.
        path: The file, where there is one.
        line: Its line, from 1, where there is one.
        column: Its column, from 1, where there is one.
    """

    code: str
    message: str
    fields: dict[str, Any] = field(repr=False)
    fabric: str | None = None
    path: str | None = None
    line: int | None = None
    column: int | None = None

    def __str__(self) -> str:
        place = ":".join(str(part) for part in (self.path, self.line, self.column) if part is not None)
        return f"{place or self.fabric or 'kesf'}: {self.code} {self.message}"


class KesfWarning(UserWarning):
    """Something of an input could not be read, and the result is of the rest.

    ``warnings.simplefilter("error", kesf.KesfWarning)`` makes an exception of it.
    """


@dataclass(frozen=True)
class Failure(Finding):
    """Why an input or a task of several gave no result; the others went on.

    Attributes:
        hint: What to do, where the failure itself says so; ``cure`` is that, or what the table of codes says.
    """

    hint: str | None = None

    @property
    def cure(self) -> str | None:
        """What to do."""
        return self.hint or _cure_of(self.code)

    def error(self) -> KesfError:
        """The same as an exception, for those who want to raise it."""
        return KesfError(
            self.message,
            code=self.code,
            path=self.path,
            line=self.line,
            column=self.column,
            cure=self.hint,
            fields=self.fields,
        )


def _cure_of(code: str) -> str | None:
    text = _kesf.explain(code)
    return None if text is None else str(json.loads(text)["cure"])


def findings_of(text: str) -> tuple[Finding, ...]:
    """Findings of their JSON."""
    return tuple(Finding(**entry) for entry in json.loads(text))


def failures_of(text: str) -> tuple[Failure, ...]:
    """Failures of their JSON."""
    return tuple(Failure(**entry) for entry in json.loads(text))
