"""Two seconds of a stiff valve, simulated and measured against the one as described."""

import numpy as np
import pytest

import pierburg_ros as pr


@pytest.fixture(scope="session")
def stiff():
    """A valve whose winding is warm."""
    return pr.Model.nominal("pierburg").with_values({"armature_resistance": 4.7})


@pytest.fixture(scope="session")
def simulation(stiff):
    """Ten seconds under steps of duty, 3 mV of noise."""
    time = np.arange(0.0, 10.0, 0.004)
    duty = np.choose((time / 1.25).astype(int) % 4, [0.0, 0.24, 0.3, 0.1])
    return pr.simulate(stiff, duty=duty, time=time, noise=0.003)


@pytest.fixture(scope="session")
def comparison(simulation):
    """The stiff valve beside the one as described."""
    return pr.compare(simulation.recording, pr.Model.nominal())


@pytest.fixture(scope="session")
def identification(simulation):
    """What the recording of the stiff valve shows of its parameters."""
    return pr.identify(simulation.recording, jobs=1)
