"""Numbers of Lin, Ma & Lo, Chin. Phys. B 25 (2016), as its text states them; no figure was digitised.

Times in s, flows in 1/s, v_d in m/s. A pair is a range from least to greatest.
"""

# Fig. 4 and its text: N = 100, v_d = 1; clearance time by strength A (N) of the social force; "further increasing the
# value of A from 300 N to 500 N barely affects the flow rate"
FIG4_N = 100
FIG4_V_D = 1.0
FIG4_A = (200.0, 300.0, 400.0, 500.0)
FIG4_CLEARANCE_TIME = {200.0: 170.0, 300.0: 120.0, 500.0: 120.0}
FIG4_FRUIN_SPECIFIC_FLOW = 0.92  # 1/(s m), Fruin's observation that the paper compares with

# Fig. 5 and its text: at 2 m/s clogging is more likely without rotation; at 1 m/s rotation changes nothing
FIG5_N = 100
FIG5_V_D_SAME = 1.0
FIG5_V_D_CLOGS_MORE_WITHOUT_ROTATION = 2.0

# Fig. 6: snapshots of 200 persons
FIG6_N = 200
FIG6_TIMES = (0.0, 30.0, 60.0, 120.0)

# Fig. 7 and its text: N = 200; clearance time by v_d; its mean where it goes up and down
FIG7_N = 200
FIG7_CLEARANCE_TIME = {0.6: 340.0, 1.0: 210.0}
FIG7_PLATEAU_V_D = (1.0, 1.8)
FIG7_PLATEAU_CLEARANCE_TIME = 220.0
FIG7_BLOCKED_FROM = 1.8

# Fig. 8: the same for 300 persons (figure only)
FIG8_N = 300

# Fig. 9 and its text: range of the flow in bins of 10 s, by the range of v_d; inf: no upper end is stated
FIG9_N = (100, 300)
FIG9_BIN = 10.0
FIG9_FLOW = {(0.6, 0.6): (0.4, 0.6), (1.0, 1.2): (0.3, 1.3), (1.6, float("inf")): (0.0, 1.6)}

# Fig. 10 and its text: mean flow against v_d for several N
SMOOTH_V_D = (0.6, 1.0)
TRANSITION_V_D = (1.0, 1.6)
TRANSITION_FROM = 1.0
PHASE_SEPARATION_FROM = 1.6
TRANSITION_FLOW = (0.7, 0.95)
TRANSITION_MEAN_FLOW = 0.82
PHASE_SEPARATION_FLOW = (0.0, 1.22)
BLOCKING_APPEARS = (1.4, 1.8)  # "at 1.6 m/s or above" (abstract), give or take a cell of the scan

# Text: when a run is stopped
BLOCKED_AFTER = 120.0  # nobody got out for so long
TIME_LIMIT = 1000.0
