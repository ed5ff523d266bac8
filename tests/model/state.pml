/* Everything that a state of the site consists of. m: a machine; g: a gateway, which serves machine g % MACHINES;
   g >= MACHINES is a second gateway that somebody has started on another PC. Goal k is the k-th that may be sent.
   What nothing will read any more is 0: states that differ in it only would be explored twice. */

#define machine_of(g) ((g) % MACHINES)
#define run_of(k) (((k) + TRIES - 1) / TRIES)
#define uses(r, m) ((r) % 2 == 1 || (m) == MACHINES - 1) /* every second run uses one machine only */
#define other (MACHINES - 1)
#define whole(m) ((m) != SKETCHED)

/* processes */
byte gateway[GATEWAYS], relay[MACHINES], scheduler, host;

/* machines, and what is on its way to them: one may overtake the other */
byte body[MACHINES], at_server[MACHINES], sick[MACHINES];
bit endless[MACHINES]; /* its goal does not end by itself */
byte goal_flies[MACHINES];
bit cancel_flies[MACHINES], host_cancels[MACHINES];
byte outcome[GATEWAYS]; /* of the goal that this gateway has sent; on its way to it */

/* gateways: what they know */
byte latch[GATEWAYS], held_run[GATEWAYS], held_goal[GATEWAYS];
byte sees_run[GATEWAYS];
byte waiting[GATEWAYS], current[GATEWAYS], phase[GATEWAYS]; /* goals */
bit cancelled[GATEWAYS];
byte stop[GATEWAYS];
bit confirms[GATEWAYS], asked_stop[GATEWAYS]; /* the scheduler waits for the receipt */
bit recovers[GATEWAYS], claim_open[GATEWAYS]; /* a run may still say that the machine is its own */
byte claim_run[GATEWAYS]; /* that run, by the note; ANY: unknown, but the machine was stopped; 0: it stood */
byte rearm[GATEWAYS]; /* 1: has a token, 2: waits for its note, 3: void */
byte holder[GATEWAYS], writes[GATEWAYS];
bit shown[GATEWAYS]; /* others see it latched */
bit signal[GATEWAYS]; /* the stop button, on its way to it */

/* the disk of a gateway */
bit note_armed[GATEWAYS], unproven[GATEWAYS];
byte note_run[GATEWAYS];

/* relays; the answer is that of the gateway, on its way */
byte serves[MACHINES], answer[MACHINES];
bit relay_new[MACHINES];

/* the scheduler */
byte last_run, says[MACHINES], runs[MACHINES], leaf[MACHINES], tries[MACHINES], receipt[MACHINES];
bit silent[MACHINES]; /* the process that has said so is gone */
bit hears_press;

/* the host agent */
bit duty[MACHINES], host_press[MACHINES];

/* how often things have gone wrong, and people have acted */
byte faults, presses, arms, cancels;

/* what only the promises know */
byte stopped[GATEWAYS];  /* a person has pressed stop, this gateway has received it, and nobody has re-armed; 2: during a re-arm */
bit heard[MACHINES];     /* the host agent, too, has received the press, and was neither killed nor frozen since */
bit known[GATEWAYS];     /* the disk knows of a latch, and nobody has re-armed */
bit away[GATEWAYS];      /* it was started while the host agent commanded its machine */
byte older[MACHINES];    /* the run before the newest whose goal the machine has accepted; 0: there is none, or no goal yet */

#ifdef HISTORY
short position, wanted;
byte earlier[GATEWAYS]; /* the receipt of a stop that was proven before another one began */
#endif
