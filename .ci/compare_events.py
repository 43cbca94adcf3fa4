"""Compares a training's TensorBoard events, as TensorBoard loads them, with its metrics.jsonl.

Usage: compare_events.py RUN_FOLDER. Exits with 1 and names the first difference.
"""

import json
import pathlib
import struct
import sys

from tensorboard.backend.event_processing import event_accumulator

# Tag of each number of an episode's record; a dot leads into an object. A number that is null has no event.
TAGS = {
    "episode/return": "return",
    "episode/length": "length",
    "episode/tip_error": "tip_error",
    "episode/intervention_rate": "intervention_rate",
    "window/success_rate": "success_rate",
    "window/mean_return": "mean_return",
    "limits/violations": "violations",
    "evaluation/success_rate": "confirmed",
    "learner/critic_loss": "losses.critic",
    "learner/actor_loss": "losses.actor",
    "learner/entropy_temperature": "losses.entropy_temperature",
    "learner/mean_q": "losses.mean_q",
    "learner/entropy": "losses.entropy",
}


def value_of(record, path):
    for key in path.split("."):
        record = None if record is None else record[key]
    return record


def single(value):
    """The nearest single-precision number, which is what a scalar event holds."""
    return struct.unpack("f", struct.pack("f", value))[0]


def expected(records):
    tags = {}
    for tag, path in TAGS.items():
        values = [(record["step"], value_of(record, path)) for record in records]
        present = [(step, single(value)) for step, value in values if value is not None]
        if present:
            tags[tag] = present
    return tags


def loaded(folder):
    accumulator = event_accumulator.EventAccumulator(str(folder), size_guidance={event_accumulator.SCALARS: 0})
    accumulator.Reload()
    tags = accumulator.Tags()["scalars"]
    return {tag: [(event.step, event.value) for event in accumulator.Scalars(tag)] for tag in tags}


def main(folder):
    lines = (folder / "metrics.jsonl").read_text().splitlines()
    records = [json.loads(line) for line in lines]
    if not records or records[-1]["losses"] is None:
        sys.exit(f"{folder}: no episode with an update, so that there is little to compare")
    wanted, found = expected(records), loaded(folder)
    if wanted.keys() != found.keys():
        sys.exit(f"{folder}: tags differ: {sorted(wanted.keys() ^ found.keys())}")
    for tag, events in wanted.items():
        if len(events) != len(found[tag]):
            sys.exit(f"{folder}: {tag}: {len(events)} numbers in metrics.jsonl, {len(found[tag])} events")
        for ours, theirs in zip(events, found[tag]):
            if ours != theirs:
                sys.exit(f"{folder}: {tag}: (step, value) is {ours} in metrics.jsonl, {theirs} in the events")
    count = sum(map(len, wanted.values()))
    print(f"{folder}: TensorBoard reads {len(wanted)} tags and {count} values as metrics.jsonl has them")


if __name__ == "__main__":
    main(pathlib.Path(sys.argv[1]))
