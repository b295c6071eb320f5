(* Reads data and a certificate as numbers and asks the proved checker.

   On the input stand two JSON values: the data (what the digests of a certificate are computed from) and the certificate.
   The answer is one line: "accepted" (exit code 0), "refused: ..." (1), or "not checked: ..." (3) for what the checker
   does not know. *)

open Json
module C = Checker

exception Unknown of string

let unknown message = raise (Unknown message)
let require holds otherwise = if not holds then refuse otherwise

(* What the checker does not know, where the rest of the certificate can be wrong all the same, and is looked at first. *)
let unknowns = ref []
let later message = unknowns := message :: !unknowns

(* The limits of verify: a certificate may come from a stranger. *)
let most_letters = 16_000_000 and most_brackets = 1_000_000 and most_rules = 100 and most_digits = 2_000
let longest_sum = 40_000 and longest_figure = 13_000 (* bits *)

(* What has no sign of its own by Unicode 14: codes of control and format, of other blanks than the usual one, and of
   private use. *)
let unprintable = [
  (0, 0x1f); (0x7f, 0xa0); (0xad, 0xad); (0x600, 0x605); (0x61c, 0x61c); (0x6dd, 0x6dd); (0x70f, 0x70f); (0x890, 0x891);
  (0x8e2, 0x8e2); (0x1680, 0x1680); (0x180e, 0x180e); (0x2000, 0x200f); (0x2028, 0x202f); (0x205f, 0x2064);
  (0x2066, 0x206f); (0x3000, 0x3000); (0xe000, 0xf8ff); (0xfeff, 0xfeff); (0xfff9, 0xfffb); (0x110bd, 0x110bd);
  (0x110cd, 0x110cd); (0x13430, 0x13438); (0x1bca0, 0x1bca3); (0x1d173, 0x1d17a); (0xe0001, 0xe0001); (0xe0020, 0xe007f);
  (0xf0000, 0xffffd); (0x100000, 0x10fffd)]
let printable otherwise =
  iter_codes (fun code -> require (not (List.exists (fun (a, b) -> a <= code && code <= b) unprintable)) otherwise)

let sorted_names value =
  let names = List.map text (list value) in
  require (ascending names) "expected names in order, each of them once";
  names

(* Ids are from 0 in files, and from 1 in the checker. *)
let id value = let n = number value in if Z.sign n >= 0 then Z.succ n else refuse "expected an id"

let names : (string, Z.t) Hashtbl.t = Hashtbl.create 1000
let name word = match Hashtbl.find_opt names word with
  | Some n -> n
  | None -> let n = Z.of_int (Hashtbl.length names + 1) in Hashtbl.add names word n; n
let named value = name (text value)

let map_of pairs = List.fold_left (fun m (k, v) -> C.PositiveMap.add k v m) C.PositiveMap.empty pairs
let numbered from l = List.mapi (fun i v -> (Z.of_int (i + from), v)) l
let lcm_of = List.fold_left (fun a q -> Z.lcm a q.Q.den) Z.one
let whole q = if Z.equal q.Q.den Z.one then q.Q.num else failwith "not whole"
(* A fraction of the certificate. *)
let read_fraction value =
  require (String.length (text value) <= most_digits) "a fraction has more than 2,000 digits";
  fraction value
(* Ids in order, of so many. *)
let sorted_ids count value =
  let ids = List.map id (list value) in
  require (ids <> [] && List.for_all (Z.geq (Z.of_int count)) ids) "expected ids of the network";
  let rec in_order = function a :: (b :: _ as others) -> Z.lt a b && in_order others | _ -> true in
  require (in_order ids) "expected ids in order";
  ids

(* --- the data *)

let node value = match list value with
  | [label; _; relations; contents] ->
    let ingredients = List.concat_map (fun c -> List.map named (list (snd (pair c)))) (list contents) in
    { C.label = named label; ingredients; located = List.map (fun r -> named (snd (pair r))) (list relations) }
  | _ -> refuse "expected an object node"

type data = { foon : C.foon; count_of_nodes : int; count_of_units : int; coins : Z.t; network_rates : Q.t list; sources : Json.t list }

let read_data value goals implied =
  let nodes, motions, inputs, outputs, below = match list (get "network" value) with
    | _ :: nodes :: motions :: inputs :: outputs :: below -> (list nodes, list motions, list inputs, list outputs, below)
    | _ -> refuse "expected a network" in
  let side l = List.map id (list l) in
  let detail number (ins, outs) = { C.its_number = Z.of_int number; ins = side ins; outs = side outs } in
  let sides = List.combine inputs outputs in
  (* below level 3, each unit and node stands for some of another network *)
  let detailed, merged, details = match below with
    | [] -> (nodes, List.mapi (fun i _ -> i + 1) nodes, List.mapi (fun i s -> [detail (i + 1) s]) sides)
    | [whole; stands_for] ->
      let detailed, ins, outs = match list whole with
        | [Number three; nodes; _; ins; outs] when Z.equal three Z.(~$3) -> (list nodes, list ins, list outs)
        | _ -> refuse "expected a network of level 3" in
      let places = Hashtbl.create 1000 in
      List.iteri (fun i n -> Hashtbl.replace places (canonical n) (i + 1)) nodes;
      let lowest = match get "network" value with List (Number n :: _) -> Z.equal n Z.one | _ -> false in
      let merge n = match list n with
        | [label; states; relations; _] ->
          let kept = if lowest then [label; List []; List []; List []] else [label; states; relations; List []] in
          (match Hashtbl.find_opt places (canonical (List kept)) with
           | Some place -> place
           | None -> refuse "a node has become none")
        | _ -> refuse "expected an object node" in
      let all = Array.of_list (List.combine ins outs) in
      let of_unit n = let i = Z.to_int (number n) in
        if i < 0 || i >= Array.length all then refuse "expected the id of a unit" else detail (i + 1) all.(i) in
      (detailed, List.map merge detailed, List.map (fun l -> List.map of_unit (list l)) (list stands_for))
    | _ -> refuse "expected a network" in
  let unit (motion, (ins, outs)) details =
    { C.motion = named motion; inputs = side ins; outputs = side outs; details } in
  let units = List.map2 unit (List.combine motions sides) details in
  let rates = match get "rates" value with
    | Null -> []
    | known -> List.map (fun r -> let m, q = pair r in (named m, fraction q)) (list known) in
  let possible = List.filter (fun (_, q) -> Q.sign q > 0) rates in
  let by_motion, by_unit = match get "prices" value with
    | Null -> ([], [])
    | known -> let m, u = pair known in
      let read key l = List.map (fun p -> let k, q = pair p in (key k, fraction q)) (list l) in
      (read named m, read id u) in
  if List.exists (fun (_, q) -> Q.sign q < 0) (by_motion @ by_unit) then refuse "a price is below 0";
  (* limits of prices are in hundredths *)
  let coins = Z.mul (Z.of_int 100) (lcm_of (List.map snd (by_motion @ by_unit))) in
  let in_coins = List.map (fun (k, q) -> (k, whole (Q.mul q (Q.of_bigint coins)))) in
  let foon = {
    C.nodes = map_of (numbered 1 (List.map node nodes)); detailed_nodes = map_of (numbered 1 (List.map node detailed));
    merged = map_of (numbered 1 (List.map Z.of_int merged)); units = map_of (numbered 1 units);
    kitchen = C.of_list (side (get "kitchen" value)); wanted = goals; implied;
    utensils = C.of_list (List.map named (list (get "utensils" value)));
    rates = map_of (List.map (fun (m, q) -> (m, (q.Q.num, q.Q.den))) possible);
    motion_prices = map_of (in_coins by_motion); unit_prices = map_of (in_coins by_unit) } in
  let used = List.sort_uniq compare (List.map text motions) in
  let network_rates = List.filter_map (fun m -> List.assoc_opt (name m) rates) used in
  let sources = match get "sources" value with Null -> [] | l -> list l in
  { foon; count_of_nodes = List.length nodes; count_of_units = List.length units; coins; network_rates; sources }

(* The checker knows rates above 0: a motion without one has no success. *)
let never_succeeds data =
  let never = List.exists (fun q -> Q.sign q = 0) data.network_rates in
  if never then later "a motion that never succeeds";
  never

(* --- rules *)

let natural_fraction word =
  let q = read_fraction (Text word) in
  if Q.sign q > 0 && Z.equal q.Q.den Z.one then q.Q.num else refuse "a limit counts what is no whole number above zero"

(* The rules of a certificate, of those with a limit by their number in it, how many nodes they add, and the numbers of
   all limits. *)
let read_rules data values =
  require (List.length values <= most_rules) "it has more than 100 rules";
  let sources = ref data.sources and nodes = ref data.count_of_nodes in
  let asking r = incr nodes; (Z.of_int !nodes, r) in
  let plain r = (Z.zero, r) in
  let limits = ref [] in
  let natural value = let n = Json.number value in if Z.sign n < 0 then unknown "limits below 0" else n in
  let limited number = limits := Z.of_int number :: !limits; Z.of_int (-number - 1) in
  let read number value =
    let keys = ref ["rule"] in
    let get key = keys := key :: !keys; Json.get key value in
    let str key = named (get key) in
    let num key = natural (get key) in
    let strs key = List.map name (sorted_names (get key)) in
    let limit r = [(limited number, r)] in
    let unknown_rule () = later ("the rule " ^ text (get "rule")); [] in
    let by_names least = match !sources with
      | of_units :: others ->
        sources := others;
        [plain (C.Least_names (map_of (numbered 1 (List.map (fun l -> Z.of_int (List.length (list l))) (list of_units))), least))]
      | [] -> refuse "the sources that a rule looks at are missing" in
    let found = match text (get "rule") with
    | "forbid_motion" -> [plain (C.Forbid_motion (str "forbidden_motion"))]
    | "forbid_object" -> [plain (C.Forbid_object (str "forbidden_object"))]
    | "forbid_ingredient" -> [plain (C.Forbid_ingredient (strs "allergen"))]
    | "least_rate" ->
      let least = num "least_rate" in
      if never_succeeds data then [] else [plain (C.Least_rate least)]
    | "only_sources" -> ignore (strs "allowed"); by_names Z.one
    | "at_least_videos" -> by_names (num "least_videos")
    | "motion_only_with" -> [plain (C.Motion_only_with (str "tied_motion", str "tied_utensil"))]
    | "never_heated" -> [plain (C.Never_heated (str "unheated_ingredient", strs "heats"))]
    | "require_motion" -> [asking (C.Require_motion (str "required_motion"))]
    | "require_object" -> [asking (C.Require_object (str "required_object"))]
    | "require_ingredient" -> [asking (C.Require_ingredient (str "required_ingredient"))]
    | "at_most_units" -> limit (C.At_most_units (num "max_units"))
    | "at_most_motion" -> limit (C.At_most_motion (str "limited_motion", num "max_uses"))
    | "at_most_utensil_uses" -> limit (C.At_most_utensil_uses (str "limited_utensil", num "max_utensil_uses"))
    | "at_most_price" -> limit (C.At_most_price (Z.div (Z.mul (num "max_price") data.coins) (Z.of_int 100)))
    | "own" ->
      require (List.length (List.filter (fun v -> Json.get "rule" v = Text "own") values) <= 1)
        "rules of the user's own stand twice";
      ignore (strs "constants", strs "library");
      List.iter (fun file ->
          exactly ["name"; "sha256"; "text"] file;
          printable "a file of rules has no printable name" (text (Json.get "name" file));
          require (Json.get "sha256" file = Text (Sha256.digest (text (Json.get "text" file))))
            "a text of rules does not have its digest") (list (get "files"));
      let ids l = if l = List [] then [] else sorted_ids data.count_of_units l in
      let claim c = let used, without = pair c in
        match ids used, ids without with
        | [u], [] -> [plain (C.Said_removed (C.of_list [u]))]
        | [], one_of -> [asking (C.Said_one_of (C.of_list one_of))]
        | _ -> later "claims about several units of rules of your own"; [] in
      let amounts a =
        let counted = List.concat_map (fun (n, us) ->
            let n = natural_fraction n in List.map (fun u -> (u, n)) (sorted_ids data.count_of_units us)) (pairs a) in
        require (List.length (List.sort_uniq Z.compare (List.map fst counted)) = List.length counted)
          "a limit counts a unit twice";
        map_of counted in
      let said i l =
        let a, n = pair l in
        let amounts = amounts a in
        (limited (List.length values + i), C.Said_at_most (amounts, natural n)) in
      let claims = List.concat_map claim (list (get "claims")) in
      claims @ List.mapi said (list (get "limits"))
    | "require_intermediate" -> ignore (str "required_intermediate"); unknown_rule ()
    | "all_steps" -> ignore (list (get "units")); unknown_rule ()
    | "before" -> ignore (str "earlier_motion", str "later_motion"); unknown_rule ()
    | "not_both_motions" -> ignore (str "one_motion", str "other_motion", limited number); unknown_rule ()
    | "at_most_utensils" -> ignore (num "max_utensils", limited number); unknown_rule ()
    | _ -> refuse "a rule is unknown" in
    exactly (List.sort_uniq compare !keys) value;
    found in
  let rules = List.concat (List.mapi read values) in
  (* limits are numbered after all nodes *)
  (List.map (fun (k, r) -> ((if Z.sign k < 0 then Z.sub (Z.of_int !nodes) k else if Z.sign k = 0 then Z.of_int (!nodes + 1_000_000) else k), r)) rules, !nodes, !limits)

(* --- amounts *)

let objective_names =
  ["units"; "inputs"; "inputs+ingredients"; "success"; "kitchen"; "attempts"; "price"; "dissimilarity"]

(* An objective, and by what its figures are multiplied to be whole. *)
let objective data word =
  let fractions () = List.fold_left (fun a q -> if Q.sign q > 0 then Z.lcm a q.Q.num else a) Z.one data.network_rates in
  match word with
  | "units" -> (C.Units, Z.one)
  | "inputs" -> (C.Inputs, Z.one)
  | "inputs+ingredients" -> (C.Inputs_and_ingredients, Z.one)
  | "kitchen" -> (C.Kitchen, Z.one)
  | "price" -> (C.Price, data.coins)
  | "dissimilarity" -> (C.Dissimilarity, Z.one)
  | "attempts" -> let n = fractions () in (C.Attempts n, n)
  | "success" -> ignore (never_succeeds data); (C.Success, Z.one)
  | _ -> unknown ("the objective " ^ word)

(* A part of a weight: a number, or exponents of rates. *)
type weight = Sum of Q.t | Product of (Q.t * Q.t) list

let read_weight data objectives value =
  let parts = list value in
  require (List.length parts = max 1 (List.length objectives)) "expected one part of a weight for each objective";
  let rate word =
    let q = read_fraction (Text word) in
    require (Q.sign q > 0 && Q.lt q Q.one && List.exists (Q.equal q) data.network_rates)
      "expected rates of motions in a weight, and none of 0 or 1";
    q in
  if objectives = [] then List.map (fun p -> Sum (read_fraction p)) parts
  else List.map2 (fun (f, _) part -> match f with
    | C.Success -> Product (List.map (fun (r, e) -> (rate r, read_fraction e)) (pairs part))
    | _ -> Sum (read_fraction part)) objectives parts

(* A weight for what is multiplied to be whole. *)
let multiplied objectives weight =
  if objectives = [] then weight
  else List.map2 (fun (_, k) -> function Sum q -> Sum (Q.mul (Q.of_bigint k) q) | part -> part) objectives weight

(* The sum of two weights, of numbers that are not too long. *)
let add =
  let plus a b =
    let sum = Q.add a b in
    require (Z.numbits sum.Q.num + Z.numbits sum.Q.den <= longest_sum)
      "its fractions add up to numbers that are too long";
    sum in
  let rec with_factor factors (r, e) = match factors with
    | [] -> [(r, e)]
    | (s, f) :: others when Q.equal r s -> (s, plus f e) :: others
    | other :: others -> other :: with_factor others (r, e) in
  List.map2 (fun a b -> match a, b with
    | Sum a, Sum b -> Sum (plus a b)
    | Product a, Product b -> Product (List.fold_left with_factor a b)
    | _ -> refuse "expected weights of one kind")

let denominators weight = List.concat_map (function Sum q -> [q] | Product l -> List.map snd l) weight

let largest = 1_000_000 (* bits of a power of a rate *)

let power base e =
  if Z.gt (Z.mul (Z.of_int (Z.numbits base)) e) (Z.of_int largest) then unknown "products of rates this long"
  else Z.pow base (Z.to_int e)

(* A weight times a number, which makes it whole. *)
let amount scale weight =
  let times q = whole (Q.mul (Q.of_bigint scale) q) in
  List.map (function
    | Sum q -> { C.number = times q; over = Z.one; under = Z.one }
    | Product l ->
      let factor (o, u) (r, e) =
        let e = times e in
        let a, b = if Z.sign e >= 0 then (r.Q.den, r.Q.num) else (r.Q.num, r.Q.den) in
        (Z.mul o (power a (Z.abs e)), Z.mul u (power b (Z.abs e))) in
      let over, under = List.fold_left factor (Z.one, Z.one) l in
      { C.number = Z.zero; over; under }) weight

(* --- proofs *)

type reading = {
  objectives : (C.objective * Z.t) list; words : string list; data : data; factor : Z.t; infeasible : bool;
  row : Z.t -> Z.t; limited : Z.t list; count_of_rules : int; price_rows : Z.t list; count_of_cuts : int; used_cuts : (Z.t, unit) Hashtbl.t }

let member at value = match pairs value with
  | ["unit", n] -> Z.mul Z.(~$2) (id n)
  | ["item", n] when List.mem "kitchen" at.words -> Z.succ (Z.mul Z.(~$2) (id n))
  | ["step", n] when !unknowns <> [] -> Z.neg (id n) (* of a rule that is unknown here *)
  | _ -> refuse "expected a unit or an item"

let multiples leaf = match get_opt "multiples" leaf with None -> [] | Some m -> List.map (fun (k, q) -> (k, read_fraction q)) (pairs m)

let read_cut at n =
  let k = id n in
  if Z.gt k (Z.of_int at.count_of_cuts) then refuse "expected the number of a cut";
  Hashtbl.replace at.used_cuts k ();
  k

let read_leaf at leaf =
  let rows = match get_opt "limits" leaf with None -> [] | Some l -> list l in
  let read key l =
    let read row = let n, weight = pair row in (number n, key n, read_weight at.data at.objectives weight) in
    let found = List.map read l in
    let numbers = List.map (fun (n, _, _) -> n) found in
    require (List.sort_uniq Z.compare numbers = numbers) "expected weights in order, each once";
    List.map (fun (_, k, weight) -> (k, weight)) found in
  let to_limit n =
    require (List.exists (Z.equal (number n)) at.limited) "a rule that limits nothing is given a weight";
    number n in
  let weights = read (read_cut at) (list (get "weights" leaf)) in
  (match List.map snd weights with
   | first :: others when rows = [] -> ignore (List.fold_left add first others)
   | _ -> ());
  let to_multiplied (k, weight) = (k, multiplied at.objectives weight) in
  let weights = List.map to_multiplied weights in
  (* prices are limited in hundredths there, and in coins here *)
  let adjusted (k, weight) =
    let by = if List.mem k at.price_rows then Q.make (Z.of_int 100) at.data.coins else Q.one in
    let times = function Sum q -> Sum (Q.mul by q) | Product l -> Product (List.map (fun (r, e) -> (r, Q.mul by e)) l) in
    (at.row k, List.map times weight) in
  let limits = List.map (fun row -> adjusted (to_multiplied row)) (read to_limit rows) in
  let common = lcm_of (List.concat_map (fun (_, weight) -> denominators weight) (weights @ limits)) in
  if List.mem "success" at.words then (* the checker computes such powers *)
    List.iter (fun q -> ignore (power q.Q.den (Z.mul common at.factor))) at.data.network_rates;
  let amounts = List.map (fun (k, weight) -> (k, amount (Z.mul common at.factor) weight)) in
  let rounded = List.map (fun word -> List.mem_assoc word (multiples leaf)) at.words in
  { C.scale = if at.infeasible then Z.one else common; weights = amounts weights; limits = amounts limits; rounded }

let rec read_proof at decided value =
  let decide ms = if ms = [] || List.exists (fun m -> List.mem m decided) ms || List.length (List.sort_uniq Z.compare ms) < List.length ms
    then refuse "nothing is decided, or something twice" else ms @ decided in
  match List.sort compare (List.map fst (pairs value)) with
  | ["branch"; "using"; "without"] ->
    let m = member at (get "branch" value) in
    let proof key = read_proof at (decide [m]) (get key value) in
    C.Branch (m, proof "without", proof "using")
  | ["hopeless"] -> C.Hopeless (read_cut at (get "hopeless" value))
  | ["broken"] ->
    let rule = number (get "broken" value) in
    require (Z.sign rule >= 0 && Z.lt rule (Z.of_int at.count_of_rules)) "expected the number of a rule";
    C.Broken
  | keys ->
    if List.exists (fun k -> not (List.mem k ["weights"; "limits"; "multiples"; "dear"; "others"])) keys then
      refuse "expected weights, a hopeless cut, a broken rule or a branch";
    let leaf = read_leaf at value in
    match get_opt "dear" value, get_opt "others" value with
    | None, None -> C.Weighed leaf
    | Some dear, Some others ->
      let dear = List.map (member at) (list dear) in
      C.Fixed (leaf, dear, read_proof at (decide dear) others)
    | _ -> refuse "expected a proof for what is without the dear"

(* All multiples that are stated for an objective, in one. *)
let grid_of proof words =
  let found = Hashtbl.create 8 in
  let rec look value =
    List.iter (fun (k, q) ->
        if Q.sign q <= 0 then refuse "a multiple is not above zero";
        let before = Option.value (Hashtbl.find_opt found k) ~default:q in
        (* the least common multiple of fractions *)
        Hashtbl.replace found k (Q.make (Z.lcm before.Q.num q.Q.num) (Z.gcd before.Q.den q.Q.den))) (multiples value);
    List.iter (fun key -> Option.iter look (get_opt key value)) ["without"; "using"; "others"] in
  look proof;
  Hashtbl.iter (fun k _ -> if not (List.mem k words) then refuse "a multiple is stated for another objective") found;
  fun word -> Hashtbl.find_opt found word

(* --- the certificate *)

let costs_of objectives value =
  let figures = list value in
  if List.length figures <> List.length objectives then refuse "expected what the tree costs by each objective";
  List.map2 (fun (f, k) figure ->
      let q = match f, figure with
        | (C.Units | C.Inputs | C.Inputs_and_ingredients | C.Kitchen), _ -> Q.of_bigint (number figure)
        | _ -> fraction figure in
      match f with
      | C.Success ->
        require (Q.sign q > 0) "a tree that never succeeds is no better than another";
        { C.number = Z.zero; over = q.Q.den; under = q.Q.num }
      | _ ->
        require (max (Z.numbits q.Q.num) (Z.numbits q.Q.den) <= longest_figure)
          "what the tree costs is too long a number to be written";
        let whole_figure = Q.mul (Q.of_bigint k) q in
        require (Z.equal whole_figure.Q.den Z.one) "the tree does not cost what is stated";
        { C.number = whole_figure.Q.num; over = Z.one; under = Z.one }) objectives figures

(* The rates of the units of a tree have denominators of so many bits together. *)
let bits_of_rates data units =
  let find key map = C.PositiveMap.find key map in
  List.fold_left (fun bits u -> match find u data.foon.C.units with
      | None -> refuse "expected ids of the network"
      | Some unit -> match find unit.C.motion data.foon.C.rates with
        | None -> bits
        | Some (_, denominator) -> bits + Z.numbits denominator) 0 units

(* --- measures of the user's own, of which the form is checked *)

let check_measure count (own_name, measure) =
  let letter i c = match c with 'a'..'z' -> true | 'A'..'Z' | '0'..'9' | '_' | '\'' -> i > 0 | _ -> false in
  let of_letters = own_name <> "" && List.for_all Fun.id (List.mapi letter (List.of_seq (String.to_seq own_name))) in
  require (of_letters && not (List.mem own_name objective_names)) "a measure has no name of its own";
  exactly ["rules"; "sha256"; "costs"] measure;
  require (get "sha256" measure = Text (Sha256.digest (text (get "rules" measure))))
    "the digest of a measure is not that of its rules";
  let units = List.concat_map (fun (cost, units) ->
      require (Q.sign (read_fraction (Text cost)) >= 0) "a unit costs less than 0 by a measure";
      sorted_ids count units) (pairs (get "costs" measure)) in
  require (List.length (List.sort_uniq Z.compare units) = List.length units) "a unit has two costs by a measure"

let keys = ["format"; "version"; "claim"; "goals"; "containers"; "level"; "objective"; "digests"; "rules"; "measures";
            "not_covered"; "tree"; "costs"; "bound"; "cuts"; "proof"; "seal"]

(* Nothing was changed by accident, and the data are those that it is about. *)
let check_digests data certificate =
  let digest value = Sha256.digest (canonical value) in
  let others = List.filter (fun (k, _) -> k <> "seal") (pairs certificate) in
  if get "seal" certificate <> Text (digest (Object others)) then refuse "the seal does not match: something was changed";
  let stated = get "digests" certificate in
  let stand_ins = List.filter (fun k -> k = "stand-ins") (List.map fst (pairs data)) in
  exactly (stand_ins @ ["network"; "kitchen"; "rates"; "utensils"; "prices"; "sources"]) stated;
  List.iter (fun (k, v) ->
      require (v = Text (digest (get k data))) (k ^ ": not the one that the certificate is about")) (pairs stated)

let check data certificate =
  (match get "format" certificate with
   | Text "foon-asp certificate" -> ()
   | Text "foon-asp certificate of a plan" -> unknown "plans, in which items are used up"
   | _ -> refuse "expected the format 'foon-asp certificate'");
  if not (Z.equal (number (get "version" certificate)) (Z.of_int 5)) then refuse "expected version 5 of the format";
  exactly keys certificate;
  check_digests data certificate;
  List.iter (printable "a constraint has no printable name") (sorted_names (get "not_covered" certificate));
  let texts = list (get "goals" data) in
  let goal g =
    exactly ["id"; "node"] g;
    require (List.mem (List [get "id" g; get "node" g]) texts) "a goal is not the node of its id";
    id (get "id" g) in
  let goals = List.map goal (list (get "goals" certificate)) in
  require (goals <> [] && List.length (List.sort_uniq Z.compare goals) = List.length goals)
    "expected goals, each of them once";
  let implied = match text (get "containers" certificate) with
    | "implied" -> true | "strict" -> false | _ -> refuse "expected the containers strict or implied" in
  (match list (get "network" data) with
   | level :: _ when level = get "level" certificate -> ()
   | _ -> refuse "not a claim about the level of the network");
  if List.mem_assoc "stand-ins" (pairs data) then unknown "stand-ins";
  let data = read_data data goals implied in
  let measures = pairs (get "measures" certificate) in
  List.iter (check_measure data.count_of_units) measures;
  if measures <> [] then unknown "measures of your own";
  let words = List.map text (list (get "objective" certificate)) in
  if List.length (List.sort_uniq compare words) < List.length words then refuse "an objective stands twice";
  let objectives = List.map (objective data) words in
  let rule_values = list (get "rules" certificate) in
  if not (ascending (List.map canonical rule_values)) then refuse "expected rules in order, each of them once";
  let rules, nodes, limited = read_rules data rule_values in
  (* rules that are unknown here can have nodes *)
  let cuts = List.map (sorted_ids (if !unknowns = [] then nodes else max_int)) (list (get "cuts" certificate)) in
  let stated = get "proof" certificate and claim = text (get "claim" certificate) in
  let multiple = grid_of stated words in
  let bound = match get "bound" certificate with Null -> None | b -> Some (multiplied objectives (read_weight data objectives b)) in
  let factor = match bound with Some b -> lcm_of (denominators b) | None -> Z.one in
  let grid = List.map2 (fun word (_, k) -> match multiple word with
      | None -> Z.one
      | Some q ->
        let q = Q.mul q (Q.of_bigint (Z.mul k factor)) in
        if Z.equal q.Q.den Z.one then q.Q.num else refuse "a cost is not a multiple of what is stated") words objectives in
  let price_rows = List.concat (List.mapi (fun i r -> if get "rule" r = Text "at_most_price" then [Z.of_int i] else []) rule_values) in
  let at = { objectives; words; data; factor; infeasible = claim = "infeasible"; price_rows; limited;
             count_of_rules = List.length rule_values; used_cuts = Hashtbl.create 100;
             row = (fun k -> Z.add (Z.of_int (nodes + 1)) k); count_of_cuts = List.length cuts } in
  let proof = read_proof at [] stated in
  if Hashtbl.length at.used_cuts < List.length cuts then refuse "a cut is not used by the proof";
  let cuts = map_of (numbered 1 cuts) and fs = List.map fst objectives in
  let tree = match get "tree" certificate with Null -> None | us -> Some (List.map id (list us)) in
  if (tree = None) <> (get "costs" certificate = Null) || (tree <> None && objectives = []) then
    refuse "expected a tree and what it costs, or neither";
  (* the tree is held against the rules that are known, whatever else there is *)
  Option.iter (fun us ->
      require (List.length (List.sort_uniq Z.compare us) = List.length us) "an id stands twice";
      let costs = costs_of objectives (get "costs" certificate) in
      if List.mem "success" words then
        require (bits_of_rates data us <= longest_figure) "the success rate of the tree is too long a number to be written";
      require (C.accept_tree data.foon fs rules us costs)
        "the tree does not execute, make the goals, keep to the rules and cost what is stated") tree;
  List.iter unknown !unknowns;
  match claim, tree, bound with
  | "optimal", Some us, None ->
    let costs = costs_of objectives (get "costs" certificate) in
    require (C.accept_optimal data.foon fs rules grid cuts proof us costs) "the proof does not hold"
  | "bound", _, Some b when objectives <> [] ->
    require (C.accept_bound data.foon fs rules factor grid cuts proof (amount factor b)) "the proof does not hold"
  | "infeasible", None, None when objectives = [] ->
    require (C.accept_infeasible data.foon rules cuts proof) "the proof does not hold"
  | _ -> refuse "expected the claim optimal, bound or infeasible, with what belongs to it"

let input_all () =
  let buffer = Buffer.create 1_000_000 and chunk = Bytes.create 65536 in
  let rec fill () =
    let count = input stdin chunk 0 (Bytes.length chunk) in
    if count > 0 then (Buffer.add_subbytes buffer chunk 0 count; fill ()) in
  fill ();
  Buffer.contents buffer

(* The text from a place on is no longer than what is read of a stranger. *)
let check_size input start =
  let letters = ref 0 and brackets = ref 0 in
  for i = start to String.length input - 1 do
    (match input.[i] with '[' | '{' -> incr brackets | _ -> ());
    if Char.code input.[i] land 0xC0 <> 0x80 then incr letters
  done;
  require (!letters <= most_letters && !brackets <= most_brackets)
    "it has more than 16,000,000 letters or 1,000,000 brackets"

let () =
  let answer, code =
    try
      let input = input_all () in
      let data, after = read input 0 in
      check_size input after;
      let certificate, ends = read input after in
      if ends <> String.length input then refuse "expected data and a certificate, and nothing after them";
      check data certificate;
      ("accepted", 0)
    with
    | Refused message -> ("refused: " ^ message, 1)
    | Unknown message -> ("not checked: the proved checker does not know " ^ message, 3)
    | Invalid_argument _ | Failure _ -> ("refused: its lists or numbers do not belong together", 1)
    | Stack_overflow | Z.Overflow | Out_of_memory -> ("not checked: it is too large for the proved checker", 3) in
  print_endline answer;
  exit code
