# The note of gaps: in any order the same gaps; one that is reversed or no list of spans is refused in each form.
{ printf 't_s,a\n'; awk 'BEGIN { for (i = 0; i < 2000; i++)
    if (i < 500 || (i >= 700 && i < 1000) || i >= 1200) printf "%.4f,%.6f\n", i / 1000, sin(i * i / 7000) }'; } > run.csv
ss-cat --gaps interpolate run.csv > sorted.tsv
grep '^# gaps' sorted.tsv
ss-features sorted.tsv > right
sed 's/^# gaps: .*/# gaps: 1:1.2 0.5:0.7/' sorted.tsv > unsorted.tsv
sed 's/^# gaps: .*/# gaps: 1:1.15 0.5:0.6 1.05:1.2 0.55:0.7/' sorted.tsv > joined.tsv
for file in unsorted joined; do
    ss-features $file.tsv | sed 's/^# gaps: .*/# gaps: 0.5:0.7 1:1.2/' | cmp right -
    ss-morlet --fmin 20 $file.tsv | grep -v '^# gaps' > $file.w
done
ss-morlet --fmin 20 sorted.tsv | grep -v '^# gaps' | cmp - unsorted.w
cmp unsorted.w joined.w
for gaps in 0.7:0.5 0.5:0.5 0.5 0.5: :0.7 a:b 0.5:nan 0.5:inf 0.5:0.7,1:1.2 '0.5:0.7 1:0.8' '0.5:0.7 x'; do
    sed "s/^# gaps: .*/# gaps: $gaps/" sorted.tsv > wrong.tsv
    ss-features wrong.tsv && echo "$gaps is taken"
done
ss-cat -o run.au sorted.tsv
LC_ALL=C sed 's/gaps: 0.5:0.7/gaps: 0.7:0.5/' run.au > wrong.au
ss-features wrong.au || echo $?
ss-morlet --fmin 20 sorted.tsv | sed 's/^# gaps: .*/# gaps: 2:1/' > wrong.w
ss-contour wrong.w || echo $?
# What recorders write where there is no number is a gap.
for word in OVR '#NV' '-nan(ind)' '1.#QNAN' Overload null; do
    printf 't_s,a\n0,1\n0.1,2\n0.2,%s\n0.3,4\n0.4,5\n' "$word" > word.csv
    ss-cat word.csv > none && echo "$word: read as a number"
    ss-cat --gaps interpolate word.csv | sed -n '8p'
done
printf 't_s,a\n0,1\n0.1,2\n0.2,later\n0.3,4\n' > word.csv
ss-cat --gaps interpolate word.csv || echo "$?"
