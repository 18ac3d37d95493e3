"""The published numbers agree with each other where the paper states them twice."""

import pytest

from studies.published import lin2016


def test_the_states_of_lin_et_al_follow_each_other_without_a_gap():
    assert lin2016.SMOOTH_V_D[1] == lin2016.TRANSITION_V_D[0] == lin2016.TRANSITION_FROM
    assert lin2016.TRANSITION_V_D[1] == lin2016.PHASE_SEPARATION_FROM


def test_the_published_mean_flow_lies_in_its_published_range():
    low, high = lin2016.TRANSITION_FLOW
    assert low < lin2016.TRANSITION_MEAN_FLOW < high


@pytest.mark.parametrize("v_d", [0.6, 1.0])
def test_the_published_clearance_times_are_flows_below_the_published_greatest(v_d):
    flow = lin2016.FIG7_N / lin2016.FIG7_CLEARANCE_TIME[v_d]
    assert lin2016.FIG9_FLOW[(0.6, 0.6)][0] < flow < lin2016.PHASE_SEPARATION_FLOW[1]
