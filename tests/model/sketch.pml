/* A machine of which only its part of the runs is there, and that goes as it likes: so a site of two machines stays small enough for two
   faults. What the other machine meets here includes all that a whole machine could do to it: everything that a whole machine may
   do with `leaf` is a step of the sketch, in any order and at any time, whatever goes wrong with it and how often. */

proctype Sketch(byte m) {
	byte r;
end:	do
	:: atomic { scheduler != DOWN && leaf[m] == NEXT -> leaf[m] = DONE }
	:: atomic { leaf[m] == NEXT -> leaf[m] = OPEN } /* it stays there */
	:: atomic { scheduler == UP && (leaf[m] == NEXT || leaf[m] == OPEN || leaf[m] == DONE) -> r = runs[m]; end_run(r); r = 0 }
	:: atomic { scheduler == UP && leaf[m] == ENDS -> leaf[m] = STOOD }
	:: atomic { scheduler == UP && over(m) -> r = runs[m]; end_of_run(r); r = 0 }
	:: atomic { !shown[m] -> shown[m] = 1 } /* latched: no run begins with it */
	od
}
