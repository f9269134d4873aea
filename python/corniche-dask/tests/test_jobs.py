"""The lines of ``corniche jobs``, and the order in which parts are submitted."""

from __future__ import annotations

import json
from typing import Any

import pytest

from corniche.errors import CornicheError
from corniche_dask.flow import Flow
from corniche_dask.jobs import Job, order_of_steps, parse_jobs


def line(name: str, step: str, work: float = 1.0, after: tuple[str, ...] = (), **more: Any) -> dict[str, Any]:
    return {"id": name, "step": step, "subtree": None, "share": None, "work": work, "after": list(after), "args": [], **more}


#: Two chains that meet: ways, nodes, roads; heights, top.
BUILD = [
    line("hashes", "hashes", 3),
    line("ways-1", "ways", 5),
    line("ways-2", "ways", 4),
    line("nodes-1", "nodes", 6, ("ways",)),
    line("roads", "roads", 10, ("nodes",)),
    line("heights-a", "heights", 7),
    line("heights-b", "heights", 9),
    line("top", "top", 1, ("heights",)),
    line("tiles-a", "tiles", 30, ("roads", "top"), subtree="1/0/0"),
    line("tiles-b", "tiles", 40, ("roads", "top"), subtree="1/1/0"),
    line("merge", "merge", 2, ("hashes", "tiles")),
]


def parsed(lines: list[dict[str, Any]]) -> list[Job]:
    return parse_jobs("\n".join(json.dumps(value) for value in lines) + "\n")


def test_lines_are_parts() -> None:
    text = (
        '{"id":"tiles-2-1-3","step":"tiles","subtree":"2/1/3","share":null,"work":123456.0,"after":[],'
        '"args":["--step","tiles","--subtree","2/1/3"]}\n'
        '{"id":"merge","step":"merge","subtree":null,"share":null,"work":1,"after":["tiles"],"args":[]}\n'
    )
    tiles, merge = parse_jobs(text)
    assert tiles == Job("tiles-2-1-3", "tiles", "2/1/3", None, 123456.0, (), ("--step", "tiles", "--subtree", "2/1/3"))
    assert tiles.title() == "step tiles, subtree 2/1/3"
    assert merge.is_merge and not tiles.is_merge


@pytest.mark.parametrize(
    ("lines", "told"),
    [
        ("no json\n", "line 1"),
        ('{"id":"a"}\n', "line 1"),
        (json.dumps(line("merge", "merge")) + "\n[]\n", "line 2"),
        (json.dumps(line("a", "tiles")) + "\n", "exactly one merge"),
        ("\n".join(json.dumps(line("merge", "merge")) for _ in range(2)), "the same id"),
        (json.dumps(line("merge", "merge", after=("tiles",))), "wait for each other"),
    ],
)
def test_lines_that_are_no_build_are_refused(lines: str, told: str) -> None:
    with pytest.raises(CornicheError, match=told):
        parse_jobs(lines)


def test_steps_that_wait_for_each_other_are_refused() -> None:
    lines = [line("a", "heights", after=("top",)), line("b", "top", after=("heights",)), line("merge", "merge", after=("top",))]
    with pytest.raises(CornicheError, match="heights, merge, top"):
        parsed(lines)


def test_steps_have_an_order() -> None:
    order = order_of_steps(parsed(BUILD))
    places = {step: order.index(step) for step in order}
    assert all(places[before] < places[job.step] for job in parsed(BUILD) for before in job.after)


def test_the_longest_chain_begins_first_and_within_a_step_the_largest() -> None:
    flow = Flow(parsed(BUILD))
    taken = []
    while (job := flow.take()) is not None:
        taken.append(job.id)
    # The steps after ways take 6 + 10 + 40 + 2 seconds, those after heights 1 + 40 + 2.
    assert taken == ["ways-1", "ways-2", "heights-b", "heights-a", "hashes"]


def test_a_step_begins_when_all_parts_before_it_are_made() -> None:
    flow = Flow(parsed(BUILD))
    order = []
    at_work: list[Job] = []
    while not flow.is_over:
        while len(at_work) < 2 and (job := flow.take()) is not None:
            at_work.append(job)
        job = at_work.pop(0)
        flow.made(job)
        order.append(job)
    assert len(order) == len(BUILD)
    made: set[str] = set()
    for job in order:
        for before in job.after:
            assert {other.id for other in order if other.step == before} <= made, f"{job.id} came before {before}"
        made.add(job.id)
    assert flow.steps()[-1] == ("merge", 1, 1)
    assert flow.work_left == pytest.approx(0)


def test_parts_of_a_step_are_asked_for_again_when_it_begins() -> None:
    asked = []

    def refine(step: str) -> list[Job] | None:
        asked.append((step, step in {"tiles"}))
        return parsed([line("tiles-c", "tiles", 50), line("merge", "merge")])[:1] if step == "tiles" else None

    flow = Flow(parsed(BUILD), refine)
    made = []
    while not flow.is_over:
        job = flow.take()
        assert job is not None
        made.append(job.id)
        flow.made(job)
    assert "tiles-c" in made and "tiles-a" not in made and made[-1] == "merge"
    assert [step for step, _ in asked].count("tiles") == 1


def test_a_part_is_made_once() -> None:
    flow = Flow(parsed(BUILD))
    job = flow.take()
    assert job is not None
    flow.made(job)
    with pytest.raises(CornicheError, match="never submitted"):
        flow.made(job)
