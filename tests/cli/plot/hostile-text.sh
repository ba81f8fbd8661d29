# Titles, names and notes draw; they do not run.
# shellcheck disable=SC2016  # nothing is to be expanded, that is the point
command -v gnuplot > /dev/null || { echo "no gnuplot"; exit 77; }
hostile='"; system "touch one"; '\''; system '\''touch two'\''; `touch three` @x %s \n {/*9 x}'
ss-plot --title "$hostile" -o a.png <<END
# stickslip signal 1
# scene: $hostile
# rate: 10
# columns: t/s '.system('ls>four').'/\`ls>five\`
0	1
0.1	2
0.2	3
END
ss-sim compliant-light | sed "s/^# scene: .*/# scene: '; system 'touch six'; '\`touch seven\`/" > run.tsv
ss-plot run.tsv -o b.svg
grep -c "touch seven" b.svg
ss-morlet run.tsv | ss-contour -o c.pdf
ls
