# Times in days, as Excel, MATLAB and astronomers count them, are not read as seconds without a word.
refused() { "$@" || echo "exit $?"; }
# 2000 rows at a rate from a day on, with so many decimals
days() { awk -v rate="$1" -v day="$2" -v digits="$3" 'BEGIN {
    printf "time,x\n"; for (i = 0; i < 2000; i++) printf "%.*f,%d\n", digits, day + i / rate / 86400, i % 7 }'; }
head_of() { "$@" | sed -n '2,/columns/p'; }

echo "-- asked about"
for day in 25570.25 44197.5 60310.75 738000.5 2460310.5; do days 100 $day 12 | refused ss-cat; done
for rate in 0.1 1 50 1000 51.2; do days $rate 44197.5 11 | refused ss-features; done
days 100 44197.5 11 | sed 1d | refused ss-cat
days 100 44197.5 11 | sed '1000,1020d' | refused ss-cat --gaps=split
days 100 44197.5 11 | awk 'NR != 500' | refused ss-cat --resample 50
days 100 44197.5 11 | sed '1000,1020d' | refused ss-cat
days 500 44197.5 8 | refused ss-cat
# where the days of each calendar begin and end: Excel's or MJD, MATLAB's, Julian
for day in 20000 80000 690000 770000 2430000 2490000; do
    for from in $((day - 1)) $day; do
        days 100 $from 12 | ss-cat 2> why > rows && echo "$from: seconds" || echo "$from: days?"
    done
done
echo "-- read as days: 100 Hz to 1 ms and better"
for day in 25570.25 44197.5 60310.75 738000.5 2460310.5; do days 100 $day 12 | head_of ss-cat --time-unit d; done
for rate in 0.1 1 50 1000 51.2; do days $rate 44197.5 11 | head_of ss-cat --time-unit d; done
for digits in 8 9 10; do days 100 44197.5 $digits | head_of ss-cat --time-unit d; done
echo "-- no more digits than needed: 0.22 periods, with and without a row missing; 0.43 periods"
days 500 44197.5 8 | head_of ss-cat --time-unit d
for row in 3 1000 1999; do days 500 44197.5 8 | sed "${row}d" | refused ss-cat -q --time-unit d; done
days 1000 44197.5 8 | refused ss-cat -q --time-unit d
days 100 44197.99999 12 | ss-cat --time-unit d | sed -n '4p; 90,93p'
days 100 -1.5 12 | head_of ss-cat --time-unit d
days 100 0 12 | head_of ss-cat --time-unit d
days 100 44197.5 12 | sed '2s/^[^,]*//' | head_of ss-cat --time-unit d --gaps=split
days 100 44197.5 11 | head_of ss-cat --time-unit d --resample 50
days 100 44197.5 11 | sed '1s/time/time (days)/' | head_of ss-cat
days 100 44197.5 11 | sed '1s/time/t_d/' | head_of ss-cat
days 100 738000.5 12 | sed '1s/time/datenum/' | head_of ss-cat
days 100 60310.5 12 | sed '1s/time/MJD/' | head_of ss-cat
days 100 44197.5 11 > run.csv
for tool in ss-noise ss-morlet ss-features ss-plot; do
    case $tool in ss-noise) set -- --rms 1 ;; *) set -- ;; esac
    $tool "$@" --time-unit d run.csv > "$tool.out" 2> err || { echo "$tool"; cat err; }
done
grep '^# rate' ss-noise.out
echo "-- seconds"
days 100 44197.5 11 | head_of ss-cat --time-unit s
seconds() { awk -v rate="$1" 'BEGIN {
    printf "time,x\n"; for (i = 0; i < 2000; i++) printf "%.9f,%d\n", 45000 + i / rate, i % 7 }'; }
for rate in 100 1000 9600 96000; do
    seconds $rate | awk 'NR != 500' > rows
    refused ss-cat < rows
    # a pipe hands on the rows before a gap, if the clock shows at once, however they come
    cat rows | refused ss-cat > at-once 2> why
    { head -c 3000 rows; sleep .2; tail -c +3001 rows; } | refused ss-cat 2>> why | cmp - at-once
    grep -c '^4' at-once || true
    uniq why
    seconds $rate | awk 'NR != 500' | ss-cat --gaps=split | sed -n 2,4p
    seconds $rate | awk 'NR != 500' | ss-cat --resample "$rate" --gaps=split | sed -n 2,4p
done
for rate in 100 1000 1440 9600 19200 25600 44100 48000 51200 65536 96000 100000 192000 1000000; do
    seconds $rate | refused ss-cat | sed -n 2,3p
done
