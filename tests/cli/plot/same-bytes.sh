# The same input gives the same picture, whatever the time, the user's settings, the locale and time zone.
command -v gnuplot > /dev/null || { echo "no gnuplot"; exit 77; }
ss-signal sine > run.tsv
for picture in png svg pdf eps; do ss-plot run.tsv -o first.$picture; done
second=$(date +%s)
while [ "$(date +%s)" = "$second" ]; do :; done
mkdir home
echo 'set xlabel "mine"; set terminal dumb; system "touch pwned"' > home/.gnuplot
export HOME="$PWD/home" GNUTERM="dumb; system 'touch pwned'" TZ=Asia/Tokyo LC_ALL=ja_JP.UTF-8
for picture in png svg pdf eps; do
    ss-plot run.tsv -o second.$picture
    # Cairo 1.17.6 and later may compress the date of a PDF
    [ $picture = pdf ] && ! grep -aq CreationDate first.pdf || cmp first.$picture second.$picture || true
done
ls
