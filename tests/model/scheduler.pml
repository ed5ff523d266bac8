/* The scheduler: runs, one after the other, each with the goals of its machines, which it sends by way of their relays. */

inline ask_relay(m, k) {
	printf("run %d sends goal %d to machine %d\n", runs[m], k, m);
	serves[m] = k; answer[m] = 0; relay_new[m] = 0; waiting[m] = k; cancelled[m] = 0;
	if
	:: GATEWAYS > MACHINES && waiting[GATEWAYS - 1] == 0 && gateway[GATEWAYS - 1] == UP -> waiting[GATEWAYS - 1] = k
	:: else
	fi
}

inline end_machine(m, r) { /* has the machine of a run stopped for good */
	if
	:: runs[m] == (r) && leaf[m] != ENDS && leaf[m] != STOOD ->
		if
		:: leaf[m] == OPEN && relay[m] != DOWN && serves[m] != 0 && (waiting[m] == serves[m] || current[m] == serves[m]) -> cancelled[m] = 1
		:: else
		fi;
		leaf[m] = ENDS; tries[m] = 0; receipt[m] = 0; relay_new[m] = 0
	:: else
	fi
}

inline end_run(r) {
	end_machine(0, r);
	if
	:: MACHINES > 1 -> end_machine(other, r)
	:: else
	fi
}

inline take(m, r) {
	if
	:: uses(r, m) -> says[m] = (whole(m) -> r : 0); silent[m] = 0; runs[m] = r; leaf[m] = NEXT
	:: else
	fi
}

inline drop(m, r) {
	if
	:: runs[m] == (r) -> says[m] = 0; silent[m] = 0; runs[m] = 0; leaf[m] = 0
	:: else
	fi
}

inline end_of_run(r) {
	printf("run %d is over\n", r);
	drop(0, r);
	if
	:: MACHINES > 1 -> drop(other, r)
	:: else
	fi
}

#ifdef HISTORY /* a press has arrived before the next run begins */
#define free(m, r) (runs[m] == 0 && (!signal[m] || gateway[m] == FROZEN))
#else
#define free(m, r) (!uses(r, m) || (runs[m] == 0 && !shown[m]))
#endif
#define finished(m, r) (runs[m] != (r) || leaf[m] == DONE)
#define stands(m, r) (runs[m] != (r) || (leaf[m] == STOOD && (serves[m] == 0 || relay[m] != UP)))
#define over(m) (runs[m] != 0 && ((finished(0, runs[m]) && finished(other, runs[m])) || (stands(0, runs[m]) && stands(other, runs[m]))))
#define begins (whole(other) -> other : 0) /* the one process of a machine that begins runs */
#define asks_for_stop(m) ((leaf[m] == ENDS || leaf[m] == AGAIN) && receipt[m] == 0)

proctype Runs(byte m) { /* what the run of machine m does with it */
	byte r;
end:	do
	:: atomic { m == begins && scheduler == UP && last_run < RUNS && free(0, last_run + 1) && free(other, last_run + 1) &&
		see(BEGINS, 0, last_run + 1) -> seen;
		last_run++;
		printf("run %d begins\n", last_run);
		take(0, last_run);
		if
		:: MACHINES > 1 -> take(other, last_run)
		:: else
		fi }
	:: atomic { scheduler == UP && leaf[m] == NEXT && tries[m] < TRIES && relay[m] == UP && gateway[m] == UP && serves[m] == 0 && waiting[m] == 0 ->
		tries[m]++; leaf[m] = OPEN;
		ask_relay(m, (runs[m] - 1) * TRIES + tries[m]) }
	:: atomic { scheduler == UP && leaf[m] == NEXT && tries[m] == TRIES -> r = runs[m]; end_run(r); r = 0 }
	:: atomic { scheduler == UP && leaf[m] == OPEN && (relay_new[m] || EITHER) ->
		printf("run %d has lost the relay of machine %d\n", runs[m], m);
		leaf[m] = AGAIN; relay_new[m] = 0 }
#ifdef STOP_NOT_ASKED_AGAIN
	:: atomic { scheduler == UP && asks_for_stop(m) && !asked_stop[m] && gateway[m] == UP && receipt[m] == 0 -> receipt[m] = LOST;
#else
	:: atomic { scheduler == UP && asks_for_stop(m) && !asked_stop[m] && gateway[m] == UP ->
#endif
		printf("run %d has gateway %d stop its machine\n", runs[m], m);
		asked_stop[m] = 1; begin_stop(m, ARMED) }
	:: atomic { scheduler == UP && leaf[m] == AGAIN && (receipt[m] == GOOD || receipt[m] == BAD) -> receipt[m] = 0; leaf[m] = NEXT }
	:: atomic { scheduler == UP && leaf[m] == ENDS && (receipt[m] == GOOD || receipt[m] == BAD) -> receipt[m] = 0; leaf[m] = STOOD }
	:: atomic { scheduler == UP && leaf[m] == ENDS && gateway[m] != UP -> receipt[m] = 0; asked_stop[m] = 0; leaf[m] = STOOD } /* no receipt in its time */
	:: atomic { scheduler == UP && runs[m] != 0 && leaf[m] != ENDS && leaf[m] != STOOD && (shown[m] || hears_press) ->
		r = runs[m]; end_run(r); r = 0 }
	:: atomic { scheduler == UP && cancels < CANCELS && runs[m] != 0 && leaf[m] != ENDS && leaf[m] != STOOD -> count(cancels);
		printf("an operator cancels run %d\n", runs[m]);
		r = runs[m]; end_run(r); r = 0 }
	:: atomic { scheduler == UP && over(m) && see(OVER, 0, runs[m]) -> seen;
		r = runs[m]; end_of_run(r); r = 0 }
#ifdef HISTORY /* it hands on a press as well; to explore, the host agent's is enough */
	:: atomic { scheduler == UP && gateway[m] == UP && presses > 0 && see(HANDED_ON, m, 0) -> seen; hear_press(m) }
#endif
	/* the relay */
	:: atomic { relay[m] == UP && scheduler != FROZEN && serves[m] != 0 && (answer[m] != 0 || gateway[m] != UP || (waiting[m] != serves[m] && current[m] != serves[m])) ->
		if
		:: answer[m] != 0 -> r = answer[m]
		:: else -> r = LOST; printf("relay %d has lost its gateway\n", m)
		fi;
		serves[m] = 0; answer[m] = 0;
		if
		:: leaf[m] == OPEN && r == GOOD -> 
			if
			:: tries[m] < GOALS || EITHER -> leaf[m] = NEXT
			:: tries[m] >= GOALS || EITHER -> leaf[m] = DONE; tries[m] = 0
			fi
		:: leaf[m] == OPEN && r == LOST -> leaf[m] = AGAIN
		:: leaf[m] == OPEN && r == BAD -> leaf[m] = NEXT; r = runs[m];
			if
			:: EITHER
			:: true -> end_run(r)
			fi
		:: else
		fi;
		r = 0 }
	od
}
