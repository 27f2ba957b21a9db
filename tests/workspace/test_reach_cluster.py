"""The same call on a Dask cluster: worker processes of this machine."""

import os
import signal
import warnings

import pytest
import xarray
from dask.distributed import Client, LocalCluster

from dh2urdf import Robot
from dh2urdf.exceptions import ArgumentError, SchedulerError
from dh2urdf.workspace import reach_map
from dh2urdf.workspace.reach import run, store

GIVEN = {"step": 0.1, "orientations": 2800, "region": ((0.0, 0.8), (-0.4, 0.4), (0.0, 0.8))}


@pytest.fixture(scope="module")
def ur5e():
    return Robot.from_dh("ur5e")


@pytest.fixture(scope="module")
def cluster():
    """Two worker processes of one thread each, as ``dask worker`` makes them."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        with LocalCluster(
            n_workers=2, threads_per_worker=1, processes=True, dashboard_address=None
        ) as made:
            yield made


@pytest.fixture(scope="module")
def client(cluster):
    with Client(cluster) as made:
        yield made


@pytest.mark.parametrize("refine", [0, 1])
def test_worker_processes_make_the_same_bits(ur5e, client, tmp_path, refine):
    """Values that come back, and a store that the workers write, are those of one process."""
    given = GIVEN | {"orientations": 60, "step": 0.2} if refine else GIVEN
    alone = reach_map(ur5e, **given, refine=refine)
    xarray.testing.assert_identical(reach_map(ur5e, **given, refine=refine, client=client), alone)
    address = client.scheduler.address
    path = tmp_path / "arm.zarr"
    kept = reach_map(ur5e, **given, refine=refine, client=address, store=path)
    xarray.testing.assert_identical(kept.load(), alone)


def test_a_worker_killed_half_way_changes_nothing(ur5e, cluster, client, tmp_path):
    """Its blocks in flight are done by others, those that it had written are not done again."""
    alone, killed, path = reach_map(ur5e, **GIVEN), [], tmp_path / "arm.zarr"
    written = {}

    def kill(done, total):
        if done == 2 and not killed:
            for block in zip(*store.done(str(path)).nonzero(), strict=True):
                chunk = path.joinpath("share", "c", *map(str, block))
                written[chunk] = chunk.stat().st_mtime_ns
            killed.append(next(iter(cluster.workers.values())).pid)
            os.kill(killed[0], signal.SIGKILL)

    kept = reach_map(ur5e, **GIVEN, client=client, store=path, progress=kill)
    assert killed
    assert written
    assert {chunk: chunk.stat().st_mtime_ns for chunk in written} == written
    xarray.testing.assert_identical(kept.load(), alone)
    assert store.done(str(path)).all()


def test_a_scheduler_out_of_reach_is_one_error(ur5e, monkeypatch):
    """Nobody at an address, and what is no address, are told in one line."""
    monkeypatch.setattr("dh2urdf.workspace.reach.run.PATIENCE", 1)
    with pytest.raises(SchedulerError, match=r"tcp://127.0.0.1:9: no Dask scheduler answers there"):
        reach_map(ur5e, **GIVEN, client="tcp://127.0.0.1:9")
    with pytest.raises(ArgumentError, match="client: expected"):
        reach_map(ur5e, **GIVEN, client=5)


def test_a_client_that_registers_while_another_lets_go_of_its_work_tries_again():
    """The library asserts that the scheduler's first words are about the new client alone."""
    answers = iter([AssertionError(), AssertionError(), "client"])

    def make():
        answer = next(answers)
        if isinstance(answer, AssertionError):
            raise answer
        return answer

    assert run._registered(make) == "client"
