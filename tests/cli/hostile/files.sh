# What a name can stand for besides a file, to read and to write.
refused() { "$@" > /dev/null || echo $?; }
mkdir folder
for tool in 'ss-sim' 'ss-trade' 'ss-cat' 'ss-noise --rms 1' 'ss-plot' 'ss-morlet' 'ss-contour'; do
    refused $tool folder
    case $tool in ss-sim | ss-trade) : ;; *) refused $tool < folder ;; esac
done
refused ss-sim - < folder

ss-sim --set settle=0 --set duration=0.05 coulomb > run.tsv
ss-morlet run.tsv > c.tsv
mkdir a.tsv a.h5 a.gp a.png
refused ss-sim -o a.tsv coulomb
refused ss-cat -o a.h5 run.tsv
refused ss-plot -o a.gp run.tsv
refused ss-contour -o a.png c.tsv

# A FIFO whose writer goes away: in the middle of a row, of an AU frame, at once.
mkfifo in
head -c 600 run.tsv > in & refused ss-cat in; wait
head -c 700 c.tsv > in & refused ss-contour in; wait
ss-cat --format au run.tsv | head -c 1001 > in & refused ss-cat in; wait
head -c 60 "$SRC/data/scenes/coulomb.scene" > in & refused ss-sim in; wait
: > in & refused ss-cat in; wait
: > in & refused ss-contour in; wait

# A FIFO to write to is written to, and one whose reader goes away ends the tool silently.
mkfifo out.tsv
ss-cat -o out.tsv run.tsv & cmp out.tsv run.tsv; wait
head -n 1 out.tsv & ss-sim --set duration=1000 -o out.tsv coulomb || [ $? = 141 ] || echo "no SIGPIPE"
wait

# Links: to a file, to none yet, to nowhere, to each other.
echo old > target.tsv
ln -s target.tsv link.tsv
ss-cat -o link.tsv run.tsv
mkdir deep
ln -s ../new.tsv deep/link.tsv
ln -s deep/link.tsv chain.tsv
ss-cat -o chain.tsv run.tsv
for name in target new; do cmp $name.tsv run.tsv; done
[ -h link.tsv ] && [ -h chain.tsv ] && [ -h deep/link.tsv ] || echo "a link was replaced"
ln -s nowhere/file.tsv lost.tsv
refused ss-cat -o lost.tsv run.tsv
ln -s loop.tsv pool.tsv
ln -s pool.tsv loop.tsv
refused ss-cat -o loop.tsv run.tsv
refused ss-cat loop.tsv
refused ss-cat -o run.tsv/x.tsv run.tsv
refused ss-cat -o "$(printf %0300d 0).tsv" run.tsv
find . | grep '\.\.\|XX' || true
ls -A . deep folder
