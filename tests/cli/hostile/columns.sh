# 32767 columns: memory is bounded by values, not by rows, in each tool that reads row by row.
# shellcheck disable=SC3045  # where there is no such limit, there is none
limit() { [ -n "$SAN" ] || ulimit -v 200000 2> /dev/null || true; "$@"; }   # sanitizers map more
awk 'BEGIN { for (r = -1; r < 40; r++) for (c = 0; c < 32768; c++)
    printf "%s%s", r < 0 ? (c ? "c" c : "t") : c ? (c * r) % 7 : r / 100, c < 32767 ? "," : "\n" }' > wide.csv
(limit ss-cat -c c5 wide.csv) | tail -1
(limit ss-noise --rms 0 -c c5 wide.csv) | tail -1 | cut -f 1-7
(limit ss-morlet -q --stream -c c5 --octaves -3:-3 wide.csv) | tail -1
(limit ss-contour -q -c c5 wide.csv -o wide.gp) && echo drawn
(limit ss-plot -q -c c5 wide.csv) | grep -c '^plot'
