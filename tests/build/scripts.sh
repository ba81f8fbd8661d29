# All shell scripts pass shellcheck.
command -v shellcheck > /dev/null || { echo "no shellcheck"; exit 77; }
cd "$SRC"
shellcheck -s sh .ci/run data/*.sh tools/*.sh tests/run.sh

# These are run by sh -eu, and run.sh gives them SRC, BUILD, CC ...
find tests/*/ -name '*.sh' -exec shellcheck -s sh -S warning -e SC2034,SC2154,SC2164 {} +
