"""Numbers of Parisi & Dorso, Physica A 354 (2005) 606, as its text and Table 1 state them; no figure was digitised.

Times in s, v_d in m/s, L in m.
"""

# Sec. 3: the two sets of runs, "around 14" each
V_D = (0.8, 1.0, 1.5, 1.75, 2.0, 2.25, 2.5, 3.0, 3.5, 4.0, 5.0, 6.0, 8.0)
RUNS = 14
N, L = 200, 1.2
DOORS_V_D = 4.0
DOORS_N = {1.2: 200, 1.8: 260, 2.4: 320, 3.0: 380, 3.6: 440, 4.2: 500}  # persons by width of the door

# Table 1: evacuation time of 200 persons by v_d, and its ratio to t_eg = N 0.54 m/v_d (Sec. 4.2); at 4.0 m/s 3.10 is
# printed, though 81.3/27 is 3.01
EVACUATION_TIME = {0.8: 146.0, 1.0: 111.0, 1.5: 79.5, 2.0: 69.9, 2.5: 70.8, 3.0: 73.7, 3.5: 74.0, 4.0: 81.3}
RATIO = {0.8: 1.08, 1.0: 1.03, 1.5: 1.10, 2.0: 1.30, 2.5: 1.64, 3.0: 2.05, 3.5: 2.40, 4.0: 3.10}
SHOULDERS = 0.54  # m, mean shoulder width, of which t_eg is made

# Fig. 1 and text: times of the 160th, 180th and 200th exit; threshold of faster is slower
FIG1_RANKS = (160, 180, 200)
V_DT = 2.0

# Figs. 2 and 3: discharge curves, and delays between the 10th and the 160th exit
FIG2_V_D = (0.8, 2.0, 6.0)
FIG3_RANKS = (10, 160)

# Fig. 5: granular clusters of more than 10 persons have "a non-negligible probability for v_d > v_dt"
LARGE_CLUSTER = 10

# Fig. 6 and text: persons of blocking clusters, and how long they last at most
ARCH_PERSONS = (3, 10)
ARCH_LASTS = 6.0

# Figs. 7 and 8: bins of delay; c_ac "almost one" for the longest above v_d = 2, "at most 30 %" for the shortest
DELAY_BINS = (0.1, 0.3, 1.0, 2.3, float("inf"))
SHORTEST_BIN_C_AC = 0.3

# Sec. 5: "the mean evacuation time ... decrease[s] exponentially when the door size is increased"
DOOR_LAW = "exponential"
