# A live signal: after a pause the picture is that of the last window, as if cut out; so it is at the end, on a
# signal, and the tool ends when gnuplot fails.
ss-sim -c t,a compliant-light --set duration=3 --set rate=1000 > s.tsv
lines() { grep -v '^#' s.tsv | sed -n "$1,$2p"; }
drawn() {       # the picture of the rows FIRST to LAST
    { grep '^#' s.tsv | sed "s/^# start:.*/# start: $(lines "$1" "$1" | cut -f 1)/"; lines "$1" "$2"; } > cut.tsv
    ss-contour -q --follow cut.png "$(echo "$1 $2" | awk '{ print ($2 - $1 + 1) / 1000 }')" cut.tsv; }
is_there() { until cmp -s live.png cut.png; do sleep .1; [ $((tries += 1)) -lt 1000 ] || exit 1; done; echo "$1"; }
tries=0
mkfifo in
ss-contour --follow live.png 1 < in &
tool=$!
exec 3> in
drawn 126 1125
{ grep '^#' s.tsv; lines 1 1130; } >&3
is_there "the first 1.125 s, cut at an eighth"
drawn 1001 2000
lines 1131 2010 >&3
is_there "the next"
kill -TERM $tool
wait $tool 2> /dev/null || echo "a signal: $(($? > 128))"
exec 3>&-
drawn 2001 3000
ss-contour --follow live.png 1 < s.tsv
cmp live.png cut.png
for arguments in '' '0' '1 --signal s.tsv' '.001'; do
    # shellcheck disable=SC2086  # words
    ss-contour --follow new.png $arguments < s.tsv || echo "exit $?"
done
mkdir bin
printf '#!/bin/sh\necho no terminal >&2\nexit 1\n' > bin/gnuplot
chmod +x bin/gnuplot
PATH=$PWD/bin:$PATH ss-contour --follow new.png 1 < s.tsv || echo "exit $?"
ls new.png 2> /dev/null || true
