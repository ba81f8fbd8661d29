# A WAV file whose length looks like that of a pipe, but is true: what follows its data are no samples.
byte() { for b in "$@"; do printf '%b' "\\0$(printf %o "$b")"; done; }
{ printf 'RIFF\377\377\377\377WAVEfmt '; byte 16 0 0 0 3 0 0 16 64 31 0 0 0 0 0 0 0 0 64 0
  printf data; byte 0 0 0 128; } > big.wav
dd if=/dev/null of=big.wav bs=1 seek=$((44 + 2147483648)) 2> dd.log     # 65536 rows of 4096 channels
printf LIST >> big.wav
byte 24 0 0 0 >> big.wav
printf 'no sample, but a comment' >> big.wav
ss-cat --column ch4096 big.wav | grep -c '^[0-9]'
