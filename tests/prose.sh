#!/bin/bash
# The habits that docs/writing.md forbids, looked for in everything that a person reads: pages, comments,
# messages, help texts and names of tests. The table below has a row for each habit:
#
#   PATTERN => WHAT TO WRITE => A SENTENCE THAT IS FOUND => A SENTENCE THAT PASSES => EXCEPT
#
# PATTERN is a Perl regular expression without regard to case; a space in it matches line breaks too. In
# pages, code in backticks, indented by four columns or in a fence is not prose. A pattern that begins with ^
# matches where a sentence begins. What EXCEPT matches, passes.
#
#   tests/prose.sh [FILE|FOLDER]...     these, or README.md, docs and every folder of sources; prints a line
#                                       for each
#   tests/prose.sh --list               the habits and what to write instead
# Runs once.
set -uo pipefail
cd "$(dirname "$0")/.." || exit 1

exec perl - "$@" <<'PERL'
use strict;
use warnings;

my $table = <<'TABLE';
behind => after, beyond, following => a number stands behind the word => behind the camera => behind (?:the|an?|its) (?:eye|camera|viewer|plane|near plane|lamp|projector|mirror|glass|wall|rectangle|surface|object)
stand(?:s|ing)?|stood => is, represents, is stored => each row stands for a draw => each row is a draw
ask(?:s|ed|ing)? => request, need, enable, query => the pass asks for names => enable names
nobody|somebody|anybody|whoever|no one => name the code, the thread or the caller; or the passive => nobody waits => a phase does not wait
whom? => which code, thread or caller: "the caller that" => threads who come late => people who know graphics => (?:people|person|readers?|students?|anyone|engineers?) who
tell(?:s|ing)?|told => report, print, distinguish => the device is told => the device reports
(?:so|that) (?:many|much)|as (?:many|much) as => name the count: "N bytes", "the number of", "at most" => so many draws before => 16 draws before
alone => only X; X by itself => the key alone decides => leave it alone => (?:let|left|leaves?) (?:\w+ )?alone
(?:is|are|was|were) no => is not a, has no, is reserved => none is no name => there is no name => there (?:is|are|was|were) no|(?:is|are|was|were) no (?:longer|more|less|fewer|greater|larger|smaller|wider|later|earlier|faster|slower)
knows?|knew => has, reads, contains, records => later code knows nothing of them => people who know graphics => (?:who|must|readers?|you|to|not) know
want(?:s|ed|ing)? => needs, reads, requests => a draw wants it => a draw needs it
lives => is stored, is in => the value lives in ymm2 => the value is in ymm2
sees|saw => reads, finds, observes => the engine sees the job => the engine reads the job
say(?:s|ing)?|said => specifies, reports, prints, contains => the key says which => the key specifies which
tak(?:e|es|en|ing)(?: one)? away => subtract, remove => takes one away => subtracts one
of which => split the sentence: "N of them", "whose" => three, of which one is free => three; one of them is free
in (?:the|its|their) place of|in place of => instead of => one product in place of two => one product instead of two
at once => simultaneously, immediately, together => eight at once => eight together
likewise|thereof|therein|hereof|whereof|thereby => also, of it, in it, so => the others likewise => so do the others
pay(?:s|ing)?|paid => costs => a draw pays for it => a draw costs more
g(?:ive|ives|iving|ave) way => is spilled, is evicted, is replaced => the value gives way => the value is spilled
h(?:old|olds|eld|olding) \w+ against => validates, compares => holds it against its rules => validates it against its rules
rubbish => random bits, data that is not initialised => two runs with rubbish => two runs with random bits
not there => absent, missing, not installed => a renderer that is not there => a missing renderer
^(?:What|Who|Whom|Whoever|Whether)\b(?![^.;:\x01]*\?) => begin with a noun, or "Returns true if ..." => What is large goes in rounds. => What is large?
TABLE

sub compile { # patterns of rows, for text whose sentences begin with \x01
    my @begins = map { /^\^(.*)/s ? "(?<=\x01)$1" : () } @_;
    my $anywhere = join '|', grep { !/^\^/ } @_;
    $anywhere =~ s/ /\\s+/g;
    my $habit = qr/(?<![\w\$\{.>-])(?:$anywhere)\b(?![\w(])/i;
    return join '|', @begins, $anywhere eq '' ? () : $habit;
}

my (@rows, @patterns);
for (split /\n/, $table) {
    my ($pattern, $write, $bad, $good, $except) = split / => /;
    push @patterns, $pattern;
    push @rows, {pattern => compile($pattern), write => $write, bad => $bad, good => $good,
                 except => defined $except ? compile($except) : undef};
}
my $any_habit = compile(@patterns);

if (@ARGV && $ARGV[0] eq '--list') {
    for (@rows) { print "$_->{bad}\n    $_->{write}: $_->{good}\n" }
    exit;
}

sub blank { my $text = shift; $text =~ s/[^\n]+/ /g; return $text }

# Each of these keeps every line break, so that offsets give lines, and puts \x01 where a sentence begins.
# Other text than prose becomes a space, so that the habits are looked for in a third of the bytes.
sub sentences {
    my ($text) = @_;
    $text =~ s/([.:;!?]\s+)(?=[A-Z])/$1\x01/g;
    $text =~ s/\x01(\s+)/$1\x01/g;
    return $text;
}

sub page {
    my ($text) = @_;
    $text =~ s/^(```.*?^```)/blank($1)/gmse;
    $text =~ s/(<!--.*?-->)/blank($1)/gse;
    $text =~ s/(?<=\n\n)((?: {4,}.*\n+)+)/blank($1)/ge;
    $text =~ s/(`[^`\n]*(?:\n[^`\n]+)?`)/(my $hole = $1) =~ s{[^\n]}{,}g; $hole/ge;
    $text =~ s/(\]\([^)]*\))/blank($1)/ge;
    $text =~ s/^(#+) (What|Who|Whether)\b/$1 \l$2/gm;
    $text =~ s/(\n\n|^ *[-*>] )(?=[A-Z])/$1\x01/gm;
    return sentences($text);
}

# Comments and strings of C; in tests the names of test functions, with spaces instead of underlines.
sub c_source {
    my ($text, $tests) = @_;
    my $out = '';
    while ($text =~ m{\G(?:
        (/\*.*?\*/ | //[^\n]*) | ("(?:[^"\\\n]|\\.)*") | (^static[ ]void[ ]\w+(?=\(void\)$)) |
        (^[ ]*\#[ ]*include[^\n]* | '(?:[^'\\\n]|\\.)+' | [^/"'\n]+ | .))}gsmx) {
        my ($comment, $string, $test, $other) = ($1, $2, $3, $4);
        if (defined $comment) {
            $comment =~ s{^/[*/]+ ?}{ \x01};
            $comment =~ s{\*+/$}{ .};
            $comment =~ s{^(\s*)[*/]+ }{$1 }gm;
            $out .= $comment;
        } elsif (defined $string) {
            $string =~ s/\\[a-z]/  /g;
            $string =~ s/^"/\x01/;
            $string =~ s/"$/ /;
            $out .= $string;
        } elsif (defined $test && $tests) {
            $test =~ s/^static void /\x01/;
            $test =~ tr/_/ /;
            $out .= $test . " .";
        } else {
            $out .= blank($test // $other);
        }
    }
    return sentences($out);
}

sub commented { # comments from MARK to the end of their line, and strings if a shell reads them
    my ($text, $mark, $strings) = @_;
    my @lines = split /\n/, $text, -1;
    my $continues = 0;
    for (@lines) {
        if (/^((?:[^"']|"[^"]*"|'[^']*')*?)(?<![\w\$"'{(\[])$mark+(?![!{(]) ?(.*)$/) {
            my ($before, $comment) = ($1, $2);
            $comment =~ s/`[^`]*`//g;
            my $whole = $before =~ /^\s*$/;
            $_ = ($continues && $whole ? ' ' : "\x01") . $comment;
            $continues = $whole;
        } else {
            my $kept = '';
            if ($strings) { $kept .= "\x01$1 ." while /(?:echo|printf|holds|refuses) ["']([^"'\$]*)["']/g }
            $_ = $kept;
            $continues = 0;
        }
    }
    return sentences(join "\n", @lines);
}

sub prose_of {
    my ($file) = @_;
    open my $in, '<', $file or die "$file: $!\n";
    local $/;
    my $text = <$in>;
    $text =~ s/\r//g;
    return page($text) if $file =~ /\.md$/;
    return c_source($text, $file =~ m{(?:^|/)tests/}) if $file =~ /\.(?:c|h|def|cc|x)$/;
    return commented($text, ';', 0) if $file =~ /\.(?:asm|inc)$/;
    return commented($text, '(?:;|//)', 0) if $file =~ /\.[pv]sa$/;
    return commented($text, '#', 1) if $file =~ /\.(?:sh|awk|py|gnuplot|tri|txt|mk)$/ || $file =~ /(?:^|\/)Makefile$/;
    return '';
}

sub findings { # of one text: [offset, what was found, row]
    my ($text) = @_;
    my @found;
    return if $text !~ /$any_habit/; # most texts
    for my $row (@rows) {
        my $searched = $text;
        $searched =~ s/($row->{except})/blank($1)/ge if $row->{except};
        while ($searched =~ /$row->{pattern}/g) { push @found, [$-[0], $&, $row] }
    }
    @found = sort { $a->[0] <=> $b->[0] } @found;
    return @found;
}

my $failed = 0;
my @wrong = grep { !findings(sentences("\x01$_->{bad} .")) || findings(sentences("\x01$_->{good} .")) } @rows;
print @wrong ? "FAIL" : "ok", " prose: each habit is found, and each better sentence passes\n";
$failed = 1 if @wrong;
print "    $_->{bad} => $_->{good}\n" for @wrong;

my @places = @ARGV ? @ARGV : qw(README.md Makefile docs src emu asm tests bench);
for my $place (@places) {
    my @files = split /\0/, `git ls-files -z --cached --others --exclude-standard -- '$place'`;
    @files = grep { -f && !m{^tests/(?:data/(?:corpus|regressions)/|prose\.sh$)} } @files;
    my @report;
    for my $file (@files) {
        my $text = prose_of($file);
        for (findings($text)) {
            my ($offset, $found, $row) = @$_;
            my $line = 1 + (substr($text, 0, $offset) =~ tr/\n//);
            $found =~ s/\s+/ /g;
            push @report, "$file:$line: $found: write: $row->{write}\n";
        }
    }
    push @report, "$place: no such file\n" if !@files;
    print @report ? "FAIL" : "ok", " prose $place", @report ? " (" . @report . ")" : '', "\n", @report;
    $failed = 1 if @report;
}
exit $failed;
PERL
