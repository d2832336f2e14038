"""The laboratory: runs the experiments of the claims, and writes verdicts and a report. docs/claims.md explains it.

    python3 bench/claims [--triptych FILE] [--registry DIR] [--results DIR] [--only ID,...] [--resume] [--older]
        [--shard I/N] [--json] [--list] [--check] [--pdf]

`triptych claims` has the same options, and help for them.
"""

import argparse
import json
import os
import signal
import sys

sys.dont_write_bytecode = True
import experiment  # noqa: E402
import registry  # noqa: E402
import report  # noqa: E402
import verdict  # noqa: E402

HERE = os.path.dirname(os.path.abspath(__file__))
ROOT = os.path.dirname(os.path.dirname(HERE))


class BadUsage(Exception):
    pass


def arguments_of():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--triptych", default=os.path.join(ROOT, "build", "triptych"), metavar="FILE")
    parser.add_argument("--registry", default=HERE, metavar="DIR")
    parser.add_argument("--results", default=os.path.join(ROOT, "results"), metavar="DIR")
    parser.add_argument("--only", default="", metavar="ID,...")
    parser.add_argument("--shard", default="", metavar="I/N")
    for flag in ("--resume", "--older", "--json", "--list", "--check", "--pdf"):
        parser.add_argument(flag, action="store_true")
    return parser.parse_args()


def selected(claims, only):
    names = [name for name in only.split(",") if name] if only else list(claims.claims)
    unknown = [name for name in names if name not in claims.claims]
    if unknown:
        raise BadUsage(f"there is no claim {unknown[0]}, expected one of `triptych claims --list`")
    return [claim for name, claim in claims.claims.items() if name in names]


def part_of(chosen, shard):
    """The claims of part I of N, as triptych divides every campaign (docs/campaigns.md)."""
    try:
        index, count = (int(number) for number in shard.split("/"))
    except ValueError:
        index = count = 0
    if not 1 <= index <= count:
        raise BadUsage(f'--shard is "{shard}", expected I/N with I from 1 to N')
    return chosen[len(chosen) * (index - 1) // count : len(chosen) * index // count]


def status_now(claim):
    if claim.needs:
        return verdict.NOT_YET
    return verdict.CANNOT if claim.cannot else "tested"


def print_list(claims, chosen):
    for claim in chosen:
        experiments = ",".join(claims.experiments_of(claim)) or "-"
        print(f"{claim.id:5} {status_now(claim):22} {claim.kind:8} {experiments:30} {claim.source}")


def print_verdicts(verdicts):
    for each in verdicts:
        values = "; ".join(
            f"{value.name} {verdict.written(value, each.numbers[value.name])}"
            for value in each.claim.values
            if value.name in each.numbers
        )
        print(f"{each.claim.id:5} {each.text:22} {each.problem or values}".rstrip())
    print(", ".join(f"{count} {text}" for text, count in verdict.counts(verdicts).items() if count))


def summary(laboratory, verdicts, claims, only):
    return {
        "machine": dict(laboratory.machine.facts, commit=report.commits_of(laboratory.machine.facts, laboratory.reports)),
        "command": "triptych claims" + (f" --only {','.join(each.claim.id for each in verdicts)}" if only else ""),
        "counts": verdict.counts(verdicts),
        "claims": [each.as_json(claims) for each in verdicts],
        "experiments": [laboratory.reports[name] for name in claims.experiments if name in laboratory.reports],
    }


def run(arguments, claims, whole):
    chosen = part_of(whole, arguments.shard) if arguments.shard else whole
    laboratory = experiment.Laboratory(
        claims,
        experiment.Machine(arguments.triptych),
        arguments.results,
        arguments.triptych,
        arguments.resume,
        arguments.older,
    )
    needed = {name for claim in chosen for name in claims.experiments_of(claim)}
    laboratory.run_all([name for name in claims.experiments if name in needed])
    verdicts = [verdict.Verdict(claim, laboratory.read) for claim in chosen]
    results = summary(laboratory, verdicts, claims, arguments.only)
    if arguments.shard:
        results.update(command="claims", shard=arguments.shard, inputs=[claim.id for claim in whole])
        index = arguments.shard.split("/")[0]
        experiment.write_json(os.path.join(arguments.results, "claims", f"part-{index}.json"), results)
    elif arguments.only:
        experiment.write_json(os.path.join(arguments.results, "claims", "only.json"), results)
    else:
        experiment.write_json(os.path.join(arguments.results, "claims.json"), results)
        report.write(os.path.join(arguments.results, "report"), claims, laboratory, verdicts)
        if arguments.pdf:
            report.print_pdf(arguments.results)
    if arguments.json:
        print(json.dumps(results, indent=1))
    else:
        print_verdicts(verdicts)
    return 1 if any(each.text == verdict.NONE for each in verdicts) else 0


def main():
    arguments = arguments_of()
    signal.signal(signal.SIGTERM, signal.default_int_handler)
    try:
        claims = registry.Registry(arguments.registry)
        chosen = selected(claims, arguments.only)
        if arguments.check:
            return 0
        if arguments.list:
            print_list(claims, chosen)
            sys.stdout.flush()
            return 0
        return run(arguments, claims, chosen)
    except (registry.BadRegistry, BadUsage) as error:
        print(f"claims: {error}", file=sys.stderr)
    except BrokenPipeError:  # the reader of the output, such as head, has ended
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return 0
    except OSError as error:
        print(f"claims: {error.filename}: {error.strerror}", file=sys.stderr)
    except KeyboardInterrupt:
        print("claims: stopped; --resume continues", file=sys.stderr)
        return 130
    return 2


sys.exit(main())
