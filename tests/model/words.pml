/* The states of things, and the words of histories.

   A step that a history shows is written  guard && see(WORD, who, what) -> seen; ...
   Where the model explores, that changes nothing; where it reads a history, the step is possible only if it is next. */

#define UP 0
#define FROZEN 1
#define DOWN 2

/* the body of a machine, and what is wrong with it */
#define STANDS 0
#define STARTS 1 /* a goal is accepted; in its dead time it looks still */
#define MOVES 2
#define DEAF 1 /* obeys no cancel */
#define MUTE 2 /* tells nothing of its motion */

/* the latch of a gateway */
#define ARMED 0
#define HELD 1
#define LATCHED 2
#define ANY 255 /* any run may leave the hold: none has told itself yet; or: no leaf is excluded */

/* the active goal of a gateway, and its stop */
#define NOTING 1
#define SENT 2
#define PROVES 1
#define KEEPS 2 /* the receipt is on its way to the disk */

/* what a gateway writes */
#define WRITE_ARMED 1
#define WRITE_LATCHED 2

/* answers */
#define GOOD 1
#define BAD 2
#define LOST 3

/* what a run does with a machine */
#define NEXT 1 /* sends the next goal */
#define OPEN 2 /* waits for the end of a goal */
#define AGAIN 3 /* has it stopped after a loss, and goes on then */
#define DONE 4
#define ENDS 5 /* has it stopped for good */
#define STOOD 6

/* words of histories; `who` is a machine or gateway, or 0 */
#define KILLED_GATEWAY 1
#define KILLED_RELAY 2
#define KILLED_SCHEDULER 3
#define KILLED_HOST 4
#define FROZE_GATEWAY 5
#define FROZE_RELAY 6
#define FROZE_SCHEDULER 7
#define FROZE_HOST 8
#define STARTED_GATEWAY 9
#define STARTED_RELAY 10
#define STARTED_SCHEDULER 11
#define STARTED_HOST 12
#define PRESSED 13
#define ARMS 14
#define SENDS 15     /* what: the run */
#define ACCEPTS 16   /* what: the run */
#define CONFIRMED 17
#define UNCONFIRMED 18
#define BEGINS 19    /* what: the run */
#define OVER 20      /* what: the run */
#define HANDED_ON 21

#ifdef HISTORY /* reads one: no budgets, and what depends on the task may go either way */
#define see(word, who, what) (wanted == (word) * 1024 + (who) * 256 + (what))
#define seen c_code { now.position++; now.wanted = history_word(now.position); }
#define count(what) skip
#define may_kill(process) (process != DOWN)
#define EITHER true
#define promise(holds) (holds) /* a history that breaks one is not accepted */
#else
#define see(word, who, what) true
#define seen skip
#define count(what) what++
#define may_kill(process) (process == UP)
#define EITHER false
#define promise(holds) assert(holds)
#endif
