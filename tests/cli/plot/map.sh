# Maps: regions of a count, lines of another, over linear and logarithmic axes, missing points shown.
ss-sweep --shoot -m stops,amplitude,period --vary base_frequency=2:8:13 --vary friction=0.1:1.5:15 coulomb -o a.tsv
draw() { ss-plot "$@" || echo "exit $?"; }
draw --map base_frequency,friction,stops,amplitude a.tsv -o a.gp
grep -c -e '^\$region' -e '^\$line' -e '^\$label' a.gp
# the lines are named, and each level that is drawn has a label
grep '^set title' a.gp
awk '/^[$]/ { block = $1 } NF == 3 && $3 + 0 > 0 { on[block, $3] = 1; if (block == "$line") level[$3] = 1 }
     END { for (l in level) { n++; labelled += on["$label", l] }; print (n > 7), n - labelled }' a.gp
# regions end with the points, at the outermost of which are no half cells
awk '/^[$]/ { boxes = /^[$]region/ } boxes && NF == 4 { print $1, $3; print $2, $4 }' a.gp | sort -g | sed -n '1p;$p'
draw --map base_frequency,friction,stops a.tsv | grep 'xlabel\|label 1\|key title'
draw --map friction,base_frequency,amplitude a.tsv | grep -c 'region' || true
printf '2\t0.1\n4\t0.5\n\n5\t1\n' | draw --map base_frequency,friction,stops --line - a.tsv | sed -n '/^\$curve/,/^EOD/p'
ss-sweep -m stops,amplitude --vary mass=-1:1:3 --vary stiffness=1000:4000:4:log coulomb -o b.tsv
draw --map stiffness,mass,stops b.tsv | grep 'logscale\|none' | grep -o 'logscale x\|title .none.'
# powers of ten where numbers are long, and gnuplot's own tics where they are short
ss-sweep -m stops --vary contact_stiffness=1e4:1e6:3:log --vary contact_damping=0.1:10:3:log compliant-light |
    draw --map contact_stiffness,contact_damping,stops | sed -n "s/^set \\(.\\)tics (/\\1 /p" | tr ',' '\n' | grep "'1" | paste -sd ' '
if command -v gnuplot > /dev/null; then
    draw --map base_frequency,friction,stops,amplitude a.tsv -o a.png && test -s a.png
    draw --map base_frequency,friction,amplitude a.tsv -o a.pdf && test -s a.pdf
    gnuplot -e 'set terminal svg; set output "a.svg"' a.gp 2> log || cat log
    test -s a.svg
    draw --map stiffness,mass,stops b.tsv -o b.svg && test -s b.svg
fi
# what never moves is not what never stops; of the share alone the ends are seen
for z in stops,amplitude stops stick; do
    ss-sweep --shoot -m stops,stick,amplitude --vary base_frequency=0.8:1.2:5 --vary friction=0.2:1.2:11 den-hartog -o c.tsv
    draw --map base_frequency,friction,$z c.tsv | grep -o "title '[^']*'"
done
# a share that grows evenly up to 1 has even levels, and none at 1, where it stays: a region, which the key names; one in
# equal ratios has 1, 2, 5
for share in 'x / 16' 'exp(x / 2 - 8)'; do
    ss-sweep -m stick --vary friction=1:20:20 --vary base_frequency=2:8:3 coulomb 2> log |
        awk 'BEGIN { FS = OFS = "\t" } !/^#/ { x = $2; z = '"$share"'; $4 = z < 1 ? z : 1 } 1' > f.tsv
    draw --map friction,base_frequency,stick f.tsv |
        awk '/^[$]|^EOD/ { on = $1 == "$label" } on && NF == 3 && $2 != "<<" { print $3 }
             /^set key title/ { print $4 }' | sort -g | paste -sd ' '
done
# of two rings of one level the longer one has the label, also if it lies nearer to the origin
awk 'BEGIN { print "# stickslip sweep 1\n# scene: s\n# columns: index x/m y/m stops stick status"
             for (i = 0; i <= 24; i++) for (j = 0; j <= 24; j++) {
                 x = i / 24; y = j / 24
                 wide = 1 - sqrt((x - .3)^2 + (y - .3)^2) / .5; small = 1 - sqrt((x - .85)^2 + (y - .85)^2) / .25
                 print n++ "\t" x "\t" y "\t1\t" (wide > small ? wide : small) "\tok" } }' > two.tsv
draw --map x,y,stops,stick two.tsv |
    awk '/^[$]|^EOD/ { on = $1 == "$label" } on && NF == 3 && $2 != "<<" && $3 > .1 { n++; wide += $1 < .7 && $2 < .7 }
         END { print n, wide }'
# over one key: points of the strobe, and under them a line that is broken where there is no value
ss-sweep --simulate --strobe 4 --max-cycles 100 -m x_phase,period,floquet --vary base_frequency=0.52:0.7:4 chaos -o d.tsv
draw --map base_frequency,x_phase,floquet d.tsv -o d.gp
grep -o -e 'size = [0-9.]*\*mark' -e 'set border back' d.gp     # points as large as letters are, also on the frame
sed -n '/^\$panel2/,/^EOD/p; /^plot/p' d.gp | sed 's/\(\.[0-9][0-9]\)[0-9]*/\1/g' | uniq
sed -n '/^\$panel1/,/^EOD/p' d.gp | awk 'NF == 2 { n[$1]++ } END { for (r in n) print r, n[r] }' | sort -n
# counts have no values between two
ss-sweep -m stops,stick --vary base_frequency=2:4:5 coulomb -o e.tsv
draw --map base_frequency,stops,stick e.tsv | grep '^plot'
draw --map base_frequency d.tsv
draw --map base_frequency,x_phase --line a.tsv d.tsv
draw --map base_frequency,status d.tsv
draw --map base_frequency,friction a.tsv
draw --map base_frequency,friction,speed a.tsv
draw --map base_frequency,friction,stops,period a.tsv
draw --map base_frequency,stops,amplitude a.tsv
draw --map x,y,z -c a a.tsv
draw --line a.tsv a.tsv
ss-sim --set duration=0.01 coulomb | draw --map t,x,v
