# Elapsed times, leap seconds, year 0; and what no column of time can be.
column() { printf 'time,x\n'; i=0; for stamp; do i=$((i + 1)); echo "$stamp,$i"; done; }
refused() { "$@" || echo "exit $?"; }
read_stamps() { echo "-- $*"; column "$@" | refused ss-cat -q | sed '/^# columns/d; /signal 1/d'; }
read_stamps 00:01.234 00:01.235 00:01.236
read_stamps 00:01,5 00:02,0 00:02,5 | head -n 1
column 00:01,5 00:02,0 00:02,5 | sed 's/\(.*\),/\1;/; 1s/,/;/' | ss-cat -q
read_stamps 59:59.999 00:00.000 00:00.001
read_stamps 59:59.9 60:00.0 60:00.1
read_stamps 59:59.9 1:00:00.0 1:00:00.1
read_stamps 0:00:01 0:00:02 0:00:03
read_stamps 23:59:59.5 24:00:00.0 24:00:00.5
read_stamps 99:59:59 100:00:00 100:00:01
echo "-- leap seconds, and seconds that were rounded up"
read_stamps 2016-12-31T23:59:59Z 2016-12-31T23:59:60Z 2017-01-01T00:00:00Z 2017-01-01T00:00:01Z
read_stamps 2016-12-31T23:59:60.0 2016-12-31T23:59:60.5 2017-01-01T00:00:00.0 2017-01-01T00:00:00.5
read_stamps 2017-01-01T05:29:59+05:30 2017-01-01T05:29:60+05:30 2017-01-01T05:30:00+05:30
read_stamps 23:59:59 23:59:60 0:00:00 0:00:01
read_stamps 10:12:59 10:12:60 10:13:01 10:13:02
echo "-- year 0"
read_stamps '0000-01-01 00:00:00.0' '0000-01-01 00:00:00.1' '0000-01-01 00:00:00.2'
read_stamps '0000-02-29 23:59:59.9' '0000-03-01 00:00:00.0' '0000-03-01 00:00:00.1'
echo "-- no times"
read_stamps 00:01 00:02 00:03
read_stamps 0000-00-00T00:00:00 0000-00-00T00:00:01
read_stamps 2024:03:05 2024:03:06
read_stamps 2024-03-05T24:00:00 2024-03-05T24:00:01
column 00:01 00:02 | refused ss-cat -q --time time
# of several stamps off the others' line, the one that is farthest is named
awk 'BEGIN { print "t,a"; for (i = 0; i < 40; i++) print i / 10 + (i == 7) * .01 - (i == 25) * .03 + (i == 33) * .02 "," i }' > off.csv
! ss-cat off.csv
# one stamp off spoils two steps as much, and is named itself, not the next, whatever the rounding
for by in .48 -.48 .3 .7; do
    for row in 3 4 5 10 17 27 40; do
        awk -v by=$by -v row=$row 'BEGIN { print "t,a"; for (i = 2; i < 44; i++) printf "%.6f,%d\n", (i + (i == row) * by) / 1024, i }' > off.csv
        ! ss-cat off.csv 2> why
        grep -q "^ss-cat: off.csv:$row: .* off by 0" why || sed "s/^/row $row, off by $by: /" why
    done
done
