/* A site: machines, gateways, relays, a scheduler, a host agent, people. Its size is given by
   MACHINES GATEWAYS RUNS TRIES (goals a run sends a machine, at most) GOALS (that it needs) FAULTS PRESSES ARMS_MOST CANCELS LONG
   SKETCHED (the machine that is only sketched; MACHINES: none). */

#ifdef HISTORY
c_decl { \#include "history.h" }
#endif
#include "words.pml"
#include "state.pml"
#include "machine.pml"
#include "stops.pml"
#include "gateway.pml"
#include "scheduler.pml"
#include "host.pml"
#include "trouble.pml"
#include "sketch.pml"
#include "promises.pml"

init {
	byte n;
	atomic {
		n = 0;
#ifdef HISTORY
		c_code { now.wanted = history_word(0); };
		claim_open[0] = 1; claim_open[other] = 1;
#endif
		do
		:: n < MACHINES ->
			note_armed[n] = 1;
			if
			:: n == SKETCHED -> run Sketch(n)
			:: else -> run Machine(n); run Gateway(n); run Runs(n); run Host(n); run Trouble(n)
			fi;
			n++
		:: else -> break
		od;
		do
		:: n < GATEWAYS -> gateway[n] = DOWN; run Gateway(n); run Trouble(n); n++
		:: else -> break
		od;
		n = 0;
		run People(); run Promises()
	}
}
