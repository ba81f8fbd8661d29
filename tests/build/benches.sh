# Every benchmark compiles without a warning; those of other libraries where these are installed.
cd "$SRC"
for bench in tests/bench/*.c; do
    case $bench in *cvode*) echo '#include <cvode/cvode.h>' | $CC -E - > /dev/null 2>&1 || continue ;; esac
    # shellcheck disable=SC2086  # flags are a list
    $CC -std=c11 -D_XOPEN_SOURCE=700 -Wall -Wextra -Wpedantic -Wshadow -Iinclude -Isrc $INCLUDES \
        -fsyntax-only "$bench"
done
