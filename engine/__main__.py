"""`python -m engine`: one small run, to see that the engine works where it is installed."""

from engine import FINGERPRINT, rooms, simulate

if __name__ == "__main__":
    print(f"engine {FINGERPRINT}: {simulate(rooms.lin_room(N=20, size=8.0))}")
