"""``python -m kesf``: what a scheduler of jobs calls, and the library of fabrics.

python -m kesf evaluate kesf_data --cases cases/virtual_bending.toml --shard 3/7 -o out
python -m kesf merge out -o all.parquet
python -m kesf library build library.parquet out
python -m kesf library find library.parquet --like kesf_data/poplin --where "thickness < 0.6" -n 5
"""

from __future__ import annotations

import argparse
import os
import sys
from collections.abc import Sequence

from . import _kesf
from ._errors import KesfError
from ._functions import _options
from ._kesf import version


def main(arguments: Sequence[str] | None = None) -> int:
    """Runs a command and says how it ended: 0 done, 1 some failed or a check failed, 2 nothing done, 3 numerics."""
    options = _parser().parse_args(arguments)
    try:
        return int(options.command(options))
    except KesfError as error:
        print(f"kesf: {error}" if error.path is None else error, file=sys.stderr)
        return 2


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(prog="python -m kesf", description="Libraries of fabrics, part by part.")
    parser.add_argument("--version", action="version", version=f"kesf {version()}")
    commands = parser.add_subparsers(required=True, metavar="COMMAND")

    evaluate = commands.add_parser("evaluate", help="evaluate a shard of a library into a Parquet part")
    evaluate.add_argument("inputs", nargs="+", metavar="INPUT", help="folders and files of fabrics, paths or URLs")
    evaluate.add_argument("--cases", nargs="*", default=[], metavar="CASE", help="case files")
    evaluate.add_argument("--shard", type=_shard, default="1/1", metavar="K/N", help="which part of how many [1/1]")
    evaluate.add_argument("--settings", metavar="FILE", help="windows and thresholds of the evaluation")
    evaluate.add_argument("--drape", action="store_true", help="solve drape cases too")
    evaluate.add_argument("-o", "--output", required=True, metavar="FOLDER", help="folder of the parts, path or URL")
    evaluate.set_defaults(command=_evaluate)

    merge = commands.add_parser("merge", help="all parts as one Parquet file, in order of names")
    merge.add_argument("folder", metavar="FOLDER", help="folder of the parts, path or URL")
    merge.add_argument("--table", default="results", choices=["results", "findings", "failures"])
    merge.add_argument("-o", "--output", required=True, metavar="FILE")
    merge.set_defaults(command=_merge)

    library = commands.add_parser("library", help="a library of fabrics that answers")
    actions = library.add_subparsers(required=True, metavar="ACTION")
    build = actions.add_parser("build", help="make it of results")
    build.add_argument("output", metavar="OUT.parquet")
    build.add_argument("results", nargs="+", metavar="RESULTS", help="folders of parts or of `kesf run`")
    build.set_defaults(command=_build)
    find = actions.add_parser("find", help="fabrics within bounds, the most alike first")
    find.add_argument("library", metavar="LIBRARY.parquet")
    find.add_argument("--like", metavar="FABRIC", help="name of a fabric in the library, or the path of one")
    find.add_argument("--where", metavar="SQL", help="such as 'thickness < 0.4 and B_warp < 0.08' (KES units)")
    find.add_argument("-n", type=int, metavar="COUNT", help="how many at most [10 with --like, else all within bounds]")
    find.set_defaults(command=_find)
    return parser


def _shard(text: str) -> tuple[int, int]:
    number, _, count = text.partition("/")
    if not (number.isdigit() and count.isdigit() and 1 <= int(number) <= int(count)):
        raise argparse.ArgumentTypeError(f"`{text}` is no shard; the third of seven is 3/7")
    return int(number), int(count)


def _evaluate(options: argparse.Namespace) -> int:
    number, count = options.shard if isinstance(options.shard, tuple) else _shard(options.shard)
    if not any("://" in path or "::" in path for path in [*options.inputs, options.output]):
        for path in options.inputs:
            if not os.path.exists(path):
                raise KesfError("there is no such file or folder", code="R001", path=path)
        # What `kesf run --shard` does, by the same code.
        made = _kesf.make_part(
            [*options.inputs, *options.cases],
            _options(None, None, None, False),
            (options.settings, options.drape, (number, count, True)),
            options.output,
        )
        (kept, fabrics, rows, _, failures), (useful, numerical, fails_a_check) = made
        _tell(options.output, number, count, fabrics, None if kept else rows, failures)
        if failures and not useful:
            return 3 if failures == numerical else 2
        return int(bool(failures) or fails_a_check)
    from . import dask

    tasks = dask.plan(
        options.inputs, options.cases, options.output, shards=count, settings=options.settings, drape=options.drape
    )
    done = dask.work(tasks[number - 1])
    _tell(options.output, number, count, done.fabrics, done.rows, done.failures)
    return int(bool(done.failures))


def _tell(out: str, number: int, count: int, fabrics: int, rows: int | None, failures: int | None) -> None:
    what = "is there already" if rows is None else f"{rows} rows, {failures} failures"
    print(f"{out}: shard {number}/{count}, {fabrics} fabrics: {what}", file=sys.stderr)


def _merge(options: argparse.Namespace) -> int:
    from . import parts

    parts.write_file(options.output, parts.merge_file(options.folder, options.table))
    print(f"{options.output}: {options.table} of {len(parts.listed(options.folder))} parts", file=sys.stderr)
    return 0


def _build(options: argparse.Namespace) -> int:
    from . import library

    count = library.build(options.output, *options.results)
    print(f"{options.output}: {count} fabrics", file=sys.stderr)
    return 0


def _find(options: argparse.Namespace) -> int:
    from . import library

    found = library.find(options.library, options.like, options.where, options.n)
    print(library.write_csv(found), end="")
    return 0


if __name__ == "__main__":
    sys.exit(main())
