(** * What the checker speaks of: units, kitchens, runs, goals, costs and rules

    Nothing here is about proofs. Whoever wants to know what an accepted certificate means reads this file and the
    theorems at the end of [Checker.v]. Object nodes, units, labels, motions and places have numbers. *)

From Coq Require Import ZArith NArith List.
From Coq Require Import FMapPositive.
From Verified Require Import Amount Cuts.
Import ListNotations.
Open Scope bool_scope.

(** An object node: its label, its ingredients, and the objects that it is in or on. *)
Record node := Node { label : id; ingredients : list id; located : list id }.

(** A unit as it was written, in full detail: its number there, and its sides. *)
Record detail := Detail { its_number : id; ins : list id; outs : list id }.

(** A functional unit. Where contents or states do not count (levels 2 and 1), nodes and units are merged, and a unit has
    the details of all units that it stands for; at level 3 it stands for itself. *)
Record functional_unit := Unit { motion : id; inputs : list id; outputs : list id; details : list detail }.

Record foon := Foon {
  nodes : PositiveMap.t node;
  detailed_nodes : PositiveMap.t node;            (* those of details *)
  merged : PositiveMap.t id;                      (* of each of these the node that it became *)
  units : PositiveMap.t functional_unit;
  kitchen : set;                                  (* nodes that are there at first, and last *)
  wanted : list id;                               (* the goals: nodes *)
  implied : bool;                                 (* the container rule: implied or strict *)
  utensils : set;                                 (* labels *)
  rates : PositiveMap.t (positive * positive);    (* of motions: 3/4 is (3, 4) *)
  motion_prices : PositiveMap.t N;                (* in the smallest coin *)
  unit_prices : PositiveMap.t N                   (* of single units, in place of those of their motions *)
}.

Section Meaning.
Variable w : foon.

Definition find_or {A} (otherwise : A) (x : id) (m : PositiveMap.t A) : A :=
  match PositiveMap.find x m with Some y => y | None => otherwise end.
Definition no_node := Node 1 [] [].
Definition node_of o := find_or no_node o (nodes w).
Definition unit_of u := find_or (Unit 1 [] [] []) u (units w).
Definition is_unit u := match PositiveMap.find u (units w) with Some _ => true | None => false end.

(** ** What a unit needs and makes

    Under [implied], a utensil with one ingredient is taken as given when this ingredient, located in the utensil, is
    another input. The unit then neither needs nor makes it. A unit that stands for several needs what all of them need,
    and makes what one of them makes. *)
Definition skipped d o : bool :=
  let node_of o := find_or no_node o (detailed_nodes w) in
  implied w && mem (label (node_of o)) (utensils w)
  && match ingredients (node_of o) with
     | [only] => existsb (fun i => negb (Pos.eqb i o) && Pos.eqb (label (node_of i)) only
                                   && among (label (node_of o)) (located (node_of i))) (ins d)
     | _ => false
     end.
Definition merge := map (fun o => find_or 1%positive o (merged w)).
Definition detail_needs d := merge (filter (fun o => negb (skipped d o)) (ins d)).
Definition detail_makes d := merge (filter (fun o => negb (among o (ins d) && skipped d o)) (outs d)).
Definition needed u :=
  match details (unit_of u) with
  | [] => []
  | d :: others => filter (fun o => forallb (fun e => among o (detail_needs e)) others) (detail_needs d)
  end.
Definition made u := flat_map detail_makes (details (unit_of u)).

(** ** Runs

    A sequence of units executes if each finds what it needs: in the kitchen, or made before. *)
Fixpoint executes (have us : list id) : Prop :=
  match us with
  | [] => True
  | u :: us => is_unit u = true /\ (forall o, In o (needed u) -> mem o (kitchen w) = true \/ In o have)
               /\ executes (made u ++ have) us
  end.
Definition makes_goals (us : list id) : Prop :=
  forall o, In o (wanted w) -> mem o (kitchen w) = true \/ exists u, In u us /\ In o (made u).

(** ** Costs

    [attempts] is counted in fractions of one, so many that each unit's is whole. A figure that is missing or not whole
    is -1, which is no cost: no certificate with it is accepted. Without stand-ins nothing is dissimilar, and networks
    with stand-ins are not checked. *)
Inductive objective := Units | Inputs | Inputs_and_ingredients | Success | Kitchen | Attempts (fractions : positive) | Price | Dissimilarity.

Definition detail_price u d : option N :=
  match PositiveMap.find (its_number d) (unit_prices w) with
  | Some p => Some p
  | None => PositiveMap.find (motion (unit_of u)) (motion_prices w)
  end.
(** A unit that stands for several has the least of their prices, if all are known. *)
Fixpoint least_price u (ds : list detail) : option N :=
  match ds with
  | [] => None
  | [d] => detail_price u d
  | d :: ds => match detail_price u d, least_price u ds with Some p, Some q => Some (N.min p q) | _, _ => None end
  end.
Definition price u := least_price u (details (unit_of u)).

Definition sum_of (z : Z) := Part z 1 1.
Definition missing := sum_of (-1).
Definition figure (f : objective) u : part :=
  let ins := inputs (unit_of u) in
  match f with
  | Units => sum_of 1
  | Inputs => sum_of (Z.of_nat (length ins))
  | Inputs_and_ingredients =>
      sum_of (Z.of_nat (length ins) + Z.of_nat (length (flat_map (fun o => ingredients (node_of o)) ins)))
  | Kitchen | Dissimilarity => sum_of 0
  | Price => match price u with Some p => sum_of (Z.of_N p) | None => missing end
  | Success => match PositiveMap.find (motion (unit_of u)) (rates w) with Some (a, b) => Part 0 b a | None => missing end
  | Attempts n => match PositiveMap.find (motion (unit_of u)) (rates w) with
                  | Some (a, b) => if (Zpos n * Zpos b mod Zpos a =? 0)%Z then sum_of (Zpos n * Zpos b / Zpos a) else missing
                  | None => missing
                  end
  end.
Definition unit_cost (fs : list objective) u : amount := map (fun f => figure f u) fs.
Definition item_cost (fs : list objective) : amount := map (fun f => sum_of (match f with Kitchen => 1 | _ => 0 end)) fs.

(** The kitchen items that units need, each once. *)
Definition taken (us : list id) : list id :=
  nodup Pos.eq_dec (filter (fun o => mem o (kitchen w)) (flat_map needed us)).
Definition run_cost fs (us : list id) : amount :=
  plus (total (unit_cost fs) us) (total (fun _ => item_cost fs) (taken us)).

(** ** Rules *)
Inductive rule :=
| Forbid_motion (m : id)
| Forbid_object (l : id)
| Forbid_ingredient (names : list id)
| Least_rate (millionths : N)
| Least_names (names : PositiveMap.t N) (least : N)     (* of each unit, how many sources vouch for it *)
| Motion_only_with (m l : id)
| Never_heated (ingredient : id) (heats : list id)
| Require_motion (m : id)
| Require_object (l : id)
| Require_ingredient (name : id)
| At_most_units (n : N)
| At_most_motion (m : id) (n : N)
| At_most_utensil_uses (l : id) (n : N)
| At_most_price (coins : N)
| Said_removed (us : set)                                (* rules of the user's own: what is taken on trust of them *)
| Said_one_of (us : set)
| Said_at_most (amounts : PositiveMap.t N) (n : N).

Definition sides u := inputs (unit_of u) ++ outputs (unit_of u).
Definition labelled l o := Pos.eqb (label (node_of o)) l.
Definition holds_one_of names o :=
  among (label (node_of o)) names || existsb (fun i => among i names) (ingredients (node_of o)).
Definition has_motion m u := Pos.eqb (motion (unit_of u)) m.
Definition touches (p : id -> bool) u := existsb p (sides u).

(** Units that no run which keeps to a rule has. *)
Definition removes (r : rule) u : bool :=
  match r with
  | Forbid_motion m => has_motion m u
  | Forbid_object l => touches (labelled l) u
  | Forbid_ingredient names => touches (holds_one_of names) u
  | Least_rate n => match PositiveMap.find (motion (unit_of u)) (rates w) with
                    | Some (a, b) => (Npos a * 1000000 <? n * Npos b)%N
                    | None => true
                    end
  | Least_names names n => (match PositiveMap.find u names with Some k => k | None => 0 end <? n)%N
  | Motion_only_with m l => has_motion m u && negb (touches (labelled l) u)
  | Never_heated i heats => among (motion (unit_of u)) heats && existsb (holds_one_of [i]) (inputs (unit_of u))
  | At_most_price _ => match price u with Some _ => false | None => true end
  | Said_removed us => mem u us
  | _ => false
  end.

(** Units of which a run has at least one. *)
Definition asks (r : rule) : option (id -> bool) :=
  match r with
  | Require_motion m => Some (has_motion m)
  | Require_object l => Some (touches (labelled l))
  | Require_ingredient i => Some (touches (holds_one_of [i]))
  | Said_one_of us => Some (fun u => mem u us)
  | _ => None
  end.

(** How much each execution of a unit takes of a limit, and the limit. *)
Definition one_if (b : bool) : N := if b then 1 else 0.
Definition limit (r : rule) : option ((id -> N) * N) :=
  match r with
  | At_most_units n => Some (fun _ => 1%N, n)
  | At_most_motion m n => Some (fun u => one_if (has_motion m u), n)
  | At_most_utensil_uses l n => Some (fun u => one_if (touches (labelled l) u), n)
  | At_most_price n => Some (fun u => match price u with Some p => p | None => 0%N end, n)
  | Said_at_most amounts n => Some (fun u => match PositiveMap.find u amounts with Some a => a | None => 0%N end, n)
  | _ => None
  end.

(** A rule that a goal breaks leaves no run at all. *)
Definition broken_by_goal (r : rule) : bool :=
  match r with Forbid_ingredient names => existsb (holds_one_of names) (wanted w) | _ => false end.

Definition keeps (us : list id) (r : rule) : Prop :=
  broken_by_goal r = false
  /\ (forall u, In u us -> removes r u = false)
  /\ (forall f, asks r = Some f -> exists u, In u us /\ f u = true)
  /\ (forall f n, limit r = Some (f, n) -> (count f us <= n)%N).

(** ** Task trees: sequences of units that execute, make the goals, and keep to the rules. *)
Definition task_tree (rules : list rule) (us : list id) : Prop :=
  executes [] us /\ makes_goals us /\ Forall (keeps us) rules.
End Meaning.
