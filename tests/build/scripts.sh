# All shell scripts pass shellcheck.
command -v shellcheck > /dev/null || { echo "no shellcheck"; exit 77; }
cd "$SRC"
shellcheck -s sh .ci/run data/*.sh tools/*.sh tests/run.sh
shellcheck -s sh -e SC2154 tests/*/*.sh         # SRC, BUILD, CC ... are given by run.sh
