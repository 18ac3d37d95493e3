"""Whether distributions hold all that the repository holds of the packages: `packed.py dist/*.whl dist/*.tar.gz`."""

import subprocess
import sys
import tarfile
import zipfile

PACKAGES = ("engine", "sweep", "studies")
MARKERS = tuple(f"{package}/py.typed" for package in PACKAGES)
ALONE = ("tests/engine/test_energy.py", "Makefile", "constraints.txt", "README.md", "LICENSE", "pyproject.toml")


def held(path: str) -> set[str]:
    """Names of the files in a wheel, or in an sdist below its folder."""
    if path.endswith(".whl"):
        return set(zipfile.ZipFile(path).namelist())
    with tarfile.open(path) as archive:
        return {name.partition("/")[2] for name in archive.getnames()}


def main() -> None:
    """Say what is missing, if anything is."""
    tracked = subprocess.run(["git", "ls-files", *PACKAGES], capture_output=True, text=True, check=True).stdout.split()
    if not set(MARKERS) <= set(tracked) or not any(name.endswith(".css") for name in tracked):
        sys.exit(f"the repository itself lacks one of {', '.join(MARKERS)}, or the pages' assets")
    for path in sys.argv[1:]:
        wanted = {*tracked} if path.endswith(".whl") else {*tracked, *ALONE}
        missing = sorted(wanted - held(path))
        if missing:
            sys.exit(f"{path} lacks {len(missing)} files: {', '.join(missing[:10])}")
        print(f"{path}: all {len(wanted)} files, among them {', '.join(MARKERS)}")


if __name__ == "__main__":
    main()
